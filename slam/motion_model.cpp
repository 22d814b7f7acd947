#include "slam/motion_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "slam/camera_frame.h"
#include "slam/imu_reading.h"

namespace rovigo::slam {

namespace {

// Errors all looks at one map share; below them averaging over frames would be wishful.
constexpr double kLookFloorM = 0.004;
constexpr double kLookFloorRad = 0.002;

// Indices of height, roll, pitch and of x, y, yaw in the chart of `retract`.
constexpr std::array<int, 3> kOffPlane = {2, 3, 4};
constexpr std::array<int, 3> kInPlane = {0, 1, 5};

Matrix6d planar_prior_information(const Eigen::Matrix3d& covariance_map, double yaw,
                                  const TrackingConfig& config) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  Eigen::Matrix3d base_from_map;
  base_from_map << c, s, 0, -s, c, 0, 0, 0, 1;
  Eigen::Matrix3d covariance = base_from_map * covariance_map * base_from_map.transpose();
  covariance.diagonal() += Eigen::Vector3d(1e-6, 1e-6, 1e-6);  // 1 mm, 1 mrad: never absolute
  const Eigen::Matrix3d information = covariance.inverse();
  Matrix6d out = Matrix6d::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      out(kInPlane[static_cast<std::size_t>(i)], kInPlane[static_cast<std::size_t>(j)]) =
          information(i, j);
    }
  }
  out(2, 2) = 1.0 / std::pow(config.plane_height_sigma_m, 2);
  out(3, 3) = out(4, 4) = 1.0 / std::pow(config.plane_tilt_sigma_rad, 2);
  return out;
}

}  // namespace

PlanarInformation planar_information(const PoseSolution& solution, const TrackingConfig& config) {
  Eigen::Matrix3d aa, ab, bb;
  Eigen::Vector3d ga, gb;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const auto ii = static_cast<Eigen::Index>(i), jj = static_cast<Eigen::Index>(j);
      aa(ii, jj) = solution.information(kInPlane[i], kInPlane[j]);
      ab(ii, jj) = solution.information(kInPlane[i], kOffPlane[j]);
      bb(ii, jj) = solution.information(kOffPlane[i], kOffPlane[j]);
    }
    ga(static_cast<Eigen::Index>(i)) = solution.gradient(kInPlane[i]);
    gb(static_cast<Eigen::Index>(i)) = solution.gradient(kOffPlane[i]);
  }
  // The floor's own information on height and tilt, centred on the plane.
  const Se3 plane = from_planar(to_planar(solution.map_from_base));
  const Vector6d off = local(plane, solution.map_from_base);
  const Eigen::Vector3d weight(1.0 / std::pow(config.plane_height_sigma_m, 2),
                               1.0 / std::pow(config.plane_tilt_sigma_rad, 2),
                               1.0 / std::pow(config.plane_tilt_sigma_rad, 2));
  bb += weight.asDiagonal();
  gb += weight.cwiseProduct(Eigen::Vector3d(off(2), off(3), off(4)));
  const Eigen::Matrix3d bb_inverse = bb.inverse();

  const TPose2D pose = to_planar(solution.map_from_base);
  const double c = std::cos(pose.phi), s = std::sin(pose.phi);
  Eigen::Matrix3d map_from_base;
  map_from_base << c, -s, 0, s, c, 0, 0, 0, 1;
  PlanarInformation look;
  look.map_from_base = pose;
  look.information =
      map_from_base * (aa - ab * bb_inverse * ab.transpose()) * map_from_base.transpose();
  look.gradient = map_from_base * (ga - ab * bb_inverse * gb);
  return look;
}

MotionModel::MotionModel(const SlamConfig& config, const Rig& rig)
    : tracking_(config.tracking),
      planar_(rig.has_wheels && rig.has_extrinsics),
      planar_filter_(config.dead_reckoning),
      links_(config.dead_reckoning) {}

void MotionModel::add(const mrpt::obs::CObservationIMU& imu) {
  const ImuReading reading = imu_in_base(imu);
  const double time_s = time_of(imu);
  if (planar_) {
    if (reading.rate_rad_s) planar_filter_.add_gyro(time_s, *reading.rate_rad_s);
    if (reading.specific_force_m_s2) {
      planar_filter_.add_accelerometer(time_s, *reading.specific_force_m_s2);
    }
    return;
  }
  if (!reading.rate_rad_s) return;
  const double dt = has_gyro_ ? std::clamp(time_s - gyro_time_s_, 0.0, 0.1) : 0.0;
  gyro_turn_ = gyro_turn_ * so3_exp(*reading.rate_rad_s * dt);
  gyro_time_s_ = time_s;
  has_gyro_ = true;
}

void MotionModel::add(const mrpt::obs::CObservationOdometry& wheels) {
  if (!planar_) return;
  planar_filter_.add_wheels(time_of(wheels), wheels.odometry.asTPose());
  if (const auto step = planar_filter_.take_step()) links_.add(*step);
}

void MotionModel::mark_keyframe(int keyframe, double time_s) {
  if (planar_) links_.mark(keyframe, time_s, planar_filter_.calibration());
}

Se3 MotionModel::predict_free(double time_s) const {
  // Velocity fades where nothing confirms it.
  const double dt = std::clamp(time_s - time_s_, 0.0, 0.2);
  Vector6d step = twist_ * dt;
  if (has_gyro_) step.tail<3>() = so3_log(gyro_turn_);
  return retract(map_from_base_, step);
}

MotionPrediction MotionModel::predict(double time_s) {
  MotionPrediction out;
  if (planar_) {
    planar_filter_.advance_to(time_s);
    const TPose2D pose = planar_filter_.map_from_base();
    out.covariance = planar_filter_.pose_covariance();
    out.prior.map_from_base = from_planar(pose);
    out.prior.information = planar_prior_information(out.covariance, pose.phi, tracking_);
    out.sigma_position_m = std::sqrt(std::max(0.0, out.covariance(0, 0) + out.covariance(1, 1)));
    out.sigma_heading_rad = std::sqrt(std::max(0.0, out.covariance(2, 2)));
    out.turn_rate_rad_s.z() = planar_filter_.twist().omega;
    return out;
  }
  const double dt = std::max(0.0, time_s - time_s_);
  out.prior.map_from_base = predict_free(time_s);
  out.turn_rate_rad_s = twist_.tail<3>();
  out.sigma_position_m = tracking_.free_motion_sigma_m + 0.5 * unseen_s_;
  out.sigma_heading_rad =
      has_gyro_ ? 0.02 + 0.05 * (dt + unseen_s_) : 0.02 + 0.5 * dt + 1.0 * unseen_s_;
  out.covariance.diagonal() << Eigen::Vector2d::Constant(0.5 * std::pow(out.sigma_position_m, 2)),
      std::pow(out.sigma_heading_rad, 2);
  out.prior.information.diagonal().head<3>().setConstant(1.0 / std::pow(out.sigma_position_m, 2));
  out.prior.information.diagonal().tail<3>().setConstant(1.0 / std::pow(out.sigma_heading_rad, 2));
  return out;
}

Se3 MotionModel::correct(double time_s, const PoseSolution& solution) {
  if (planar_) {
    planar_filter_.advance_to(time_s);
    planar_filter_.correct(planar_information(solution, tracking_), kLookFloorM, kLookFloorRad);
    planar_filter_.found();
    // Height and tilt as seen, x, y and yaw as believed.
    const Se3 seen_plane = from_planar(to_planar(solution.map_from_base));
    return from_planar(planar_filter_.map_from_base()) *
           (seen_plane.inverse() * solution.map_from_base);
  }
  const double dt = time_s - time_s_;
  if (has_pose_ && dt > 1e-3 && dt < 0.5) {
    twist_ = local(map_from_base_, solution.map_from_base) / dt;
  } else {
    twist_.setZero();
  }
  map_from_base_ = solution.map_from_base;
  time_s_ = time_s;
  has_pose_ = true;
  unseen_s_ = 0.0;
  gyro_turn_.setIdentity();
  return map_from_base_;
}

Se3 MotionModel::correct(const PlanarInformation& look) {
  planar_filter_.correct(look, kLookFloorM, kLookFloorRad);
  return from_planar(planar_filter_.map_from_base());
}

void MotionModel::miss(double time_s) {
  if (planar_) return;  // the filter's own noise has grown already
  map_from_base_ = predict_free(time_s);
  unseen_s_ += std::max(0.0, time_s - time_s_);
  time_s_ = time_s;
  twist_ *= 0.7;
  gyro_turn_.setIdentity();
}

void MotionModel::place(double time_s, const Se3& map_from_base, double sigma_position_m,
                        double sigma_heading_rad) {
  if (planar_) {
    planar_filter_.advance_to(time_s);
    planar_filter_.place(to_planar(map_from_base), sigma_position_m, sigma_heading_rad);
    return;
  }
  map_from_base_ = map_from_base;
  time_s_ = time_s;
  has_pose_ = true;
  unseen_s_ = 0.0;
  twist_.setZero();
  gyro_turn_.setIdentity();
}

void MotionModel::shift(const Se3& new_map_from_old_map) {
  if (planar_) planar_filter_.shift(to_planar(new_map_from_old_map));
  map_from_base_ = new_map_from_old_map * map_from_base_;
}

}  // namespace rovigo::slam
