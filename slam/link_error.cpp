#include "slam/link_error.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>

namespace rovigo::slam {

namespace {

constexpr double kBlockS = 10.0;
constexpr double kKernel = 3.0;  // sigmas: slip that nobody noticed loses its vote
constexpr double kFloorM = 0.001, kFloorRad = 0.0001;  // no link is better than this
constexpr double kFloorHeightM = 0.005, kFloorTiltRad = 0.005;
// How far calibrations may move from block to block.
constexpr double kBiasStepRadS = 4e-4, kScaleStep = 8e-4, kDelayStepS = 8e-5;

struct LinkError {
  LinkError(const MotionLink& l, const Se3& from_pose, const Se3& to_pose)
      : link(l), from_origin(from_pose), to_origin(to_pose) {
    Eigen::Matrix3d covariance = link.covariance;
    covariance.diagonal() +=
        Eigen::Vector3d(kFloorM * kFloorM, kFloorM * kFloorM, kFloorRad * kFloorRad);
    const Eigen::Matrix3d information = covariance.inverse();
    weight = Eigen::LLT<Eigen::Matrix3d>(information).matrixU();
  }

  template <class T>
  bool operator()(const T* from_step, const T* to_step, const T* calibration, T* residual) const {
    using std::atan2, std::cos, std::sin;
    const PoseOf<T> from(from_origin, from_step), to(to_origin, to_step);
    const Eigen::Matrix<T, 3, 1> between =
        from.rotation.transpose() * (to.translation - from.translation);
    const Eigen::Matrix<T, 3, 3> turn = from.rotation.transpose() * to.rotation;
    Eigen::Matrix<T, 4, 1> moved;
    for (int i = 0; i < 4; ++i) moved(i) = calibration[i] - T(link.calibration(i));
    const Eigen::Matrix<T, 3, 1> by = link.by_calibration.cast<T>() * moved;
    const T yaw_error = atan2(turn(1, 0), turn(0, 0)) - (T(link.from_from_to.phi) + by(2));
    Eigen::Matrix<T, 3, 1> error;
    error << between(0) - (T(link.from_from_to.x) + by(0)),
        between(1) - (T(link.from_from_to.y) + by(1)), atan2(sin(yaw_error), cos(yaw_error));
    Eigen::Map<Eigen::Matrix<T, 3, 1>> out(residual);
    out = weight.cast<T>() * error;
    // Both ends stand on one floor; without this nothing would hold a blind keyframe down.
    residual[3] = between(2) / T(kFloorHeightM);
    residual[4] = turn(2, 0) / T(kFloorTiltRad);
    residual[5] = turn(2, 1) / T(kFloorTiltRad);
    return true;
  }

  const MotionLink& link;
  Se3 from_origin, to_origin;
  Eigen::Matrix3d weight;
};

/// Calibration near what it was before (or near its nominal value).
struct WalkError {
  template <class T>
  bool operator()(const T* before, const T* after, T* residual) const {
    for (int i = 0; i < 4; ++i) residual[i] = (after[i] - before[i]) / T(sigma(i));
    return true;
  }
  MotionCalibration sigma;
};

struct NominalError {
  template <class T>
  bool operator()(const T* calibration, T* residual) const {
    for (int i = 0; i < 4; ++i) residual[i] = (calibration[i] - T(nominal(i))) / T(sigma(i));
    return true;
  }
  MotionCalibration nominal, sigma;
};

}  // namespace

LinkErrors::LinkErrors(const std::vector<MotionLink>& links, const DeadReckoningConfig& config)
    : links_(links), config_(config), kernel_(kKernel) {
  if (links_.empty()) return;
  begin_s_ = links_.front().begin_s;
  for (const MotionLink& l : links_) begin_s_ = std::min(begin_s_, l.begin_s);
  for (const MotionLink& l : links_) {
    const std::size_t block = block_of(l);
    if (calibrations_.size() <= block)
      calibrations_.resize(block + 1, {0.0, 0.0, 0.0, config_.gyro_delay_s});
    if (l.by_calibration.isZero()) continue;
    Eigen::Map<MotionCalibration>(calibrations_[block].data()) = l.calibration;
  }
}

std::size_t LinkErrors::block_of(const MotionLink& link) const {
  return static_cast<std::size_t>(std::max(0.0, (link.begin_s - begin_s_) / kBlockS));
}

void LinkErrors::add_to(ceres::Problem& problem, const std::vector<Se3>& poses,
                        const StepOf& step_of) {
  for (const MotionLink& l : links_) {
    const auto from = static_cast<std::size_t>(l.from), to = static_cast<std::size_t>(l.to);
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<LinkError, 6, 6, 6, 4>(
                                 new LinkError(l, poses[from], poses[to])),
                             &kernel_, step_of(l.from), step_of(l.to),
                             calibrations_[block_of(l)].data());
  }
  if (!links_.empty()) add_walks(problem);
}

void LinkErrors::add_walks(ceres::Problem& problem) {
  const MotionCalibration nominal(0.0, 0.0, 0.0, config_.gyro_delay_s);
  const MotionCalibration sigma(config_.gyro_bias_sigma_rad_s, config_.wheel_speed_scale_sigma,
                                config_.wheel_turn_scale_sigma, config_.gyro_delay_sigma_s);
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<NominalError, 4, 4>(new NominalError{nominal, sigma}),
      nullptr, calibrations_.front().data());
  const MotionCalibration walk(kBiasStepRadS, kScaleStep, kScaleStep, kDelayStepS);
  for (std::size_t i = 1; i < calibrations_.size(); ++i) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<WalkError, 4, 4, 4>(new WalkError{walk}), nullptr,
        calibrations_[i - 1].data(), calibrations_[i].data());
  }
}

}  // namespace rovigo::slam
