#include "slam/pose_optimizer.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr double kChi2Two = 5.991;    // 95% of chi-square with two degrees of freedom
constexpr double kChi2Three = 7.815;  // with three
constexpr int kRounds = 4;
constexpr int kStepsPerRound = 5;
constexpr double kMinDepthM = 0.05;

using Matrix3x6 = Eigen::Matrix<double, 3, 6>;

struct Residual {
  Eigen::Vector3d whitened = Eigen::Vector3d::Zero();  ///< u, v, depth in sigmas
  Matrix3x6 jacobian = Matrix3x6::Zero();
  bool valid = false;
};

/// Reprojection and depth error of one landmark and its derivative in the base frame's chart.
Residual residual_of(const PointObservation& o, const Se3& pose, const CameraModel& camera,
                     const Se3& camera_from_base, bool with_jacobian) {
  Residual r;
  const Eigen::Vector3d p_base = pose.rotation.transpose() * (o.point_map - pose.translation);
  const Eigen::Vector3d p = camera_from_base * p_base;
  if (p.z() < kMinDepthM) return r;
  r.valid = true;
  const Eigen::Vector2d pixel = camera.project(p);
  const bool has_depth = o.depth_m > 0;
  r.whitened.head<2>() = (pixel - o.pixel) / o.pixel_sigma;
  if (has_depth) r.whitened.z() = (p.z() - o.depth_m) / o.depth_sigma_m;
  if (!with_jacobian) return r;

  const double iz = 1.0 / p.z();
  Eigen::Matrix3d by_point = Eigen::Matrix3d::Zero();
  by_point(0, 0) = camera.fx() * iz / o.pixel_sigma;
  by_point(0, 2) = -camera.fx() * p.x() * iz * iz / o.pixel_sigma;
  by_point(1, 1) = camera.fy() * iz / o.pixel_sigma;
  by_point(1, 2) = -camera.fy() * p.y() * iz * iz / o.pixel_sigma;
  if (has_depth) by_point(2, 2) = 1.0 / o.depth_sigma_m;
  // p_base moves by -v - w x p_base for a step (v, w) of the base.
  const Eigen::Matrix3d by_base = by_point * camera_from_base.rotation;
  r.jacobian.leftCols<3>() = -by_base;
  r.jacobian.rightCols<3>() = by_base * skew(p_base);
  return r;
}

double chi2_limit(const PointObservation& o) { return o.depth_m > 0 ? kChi2Three : kChi2Two; }

double huber_weight(double chi2, double limit) {
  return chi2 <= limit ? 1.0 : std::sqrt(limit / chi2);
}

struct Normal {
  Matrix6d h = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
};

Normal vision_normal(const std::vector<PointObservation>& observations,
                     const std::vector<std::uint8_t>& use, const Se3& pose,
                     const CameraModel& camera, const Se3& camera_from_base) {
  Normal n;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!use[i]) continue;
    const Residual r = residual_of(observations[i], pose, camera, camera_from_base, true);
    if (!r.valid) continue;
    const double w = huber_weight(r.whitened.squaredNorm(), chi2_limit(observations[i]));
    n.h.noalias() += w * r.jacobian.transpose() * r.jacobian;
    n.g.noalias() += w * r.jacobian.transpose() * r.whitened;
  }
  return n;
}

void add_prior(const PosePrior6& prior, const Se3& pose, Normal& n) {
  // d(local)/d(step) is taken as identity: the prior is never far from the solution.
  const Vector6d away = local(prior.map_from_base, pose);
  n.h += prior.information;
  n.g += prior.information * away;
}

int classify(const std::vector<PointObservation>& observations, const Se3& pose,
             const CameraModel& camera, const Se3& camera_from_base, double slack,
             std::vector<std::uint8_t>& is_inlier) {
  int inliers = 0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Residual r = residual_of(observations[i], pose, camera, camera_from_base, false);
    is_inlier[i] = r.valid && r.whitened.squaredNorm() <= slack * chi2_limit(observations[i]);
    inliers += is_inlier[i];
  }
  return inliers;
}

double rms_of_inliers(const std::vector<PointObservation>& observations, const PoseSolution& s,
                      const CameraModel& camera, const Se3& camera_from_base) {
  double sum = 0.0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!s.is_inlier[i]) continue;
    sum += residual_of(observations[i], s.map_from_base, camera, camera_from_base, false)
               .whitened.head<2>()
               .squaredNorm();
  }
  return s.inliers > 0 ? std::sqrt(sum / s.inliers) : 0.0;
}

/// True when some direction of motion is worse known than 5 cm or 0.05 rad from vision alone.
bool is_degenerate(const Matrix6d& information) {
  constexpr double kWeakest = 1.0 / (0.05 * 0.05);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(information, Eigen::EigenvaluesOnly);
  return !(eigen.eigenvalues()(0) > kWeakest);
}

}  // namespace

PoseSolution optimize_pose(const std::vector<PointObservation>& observations, const Se3& initial,
                           const std::optional<PosePrior6>& prior, const CameraModel& camera,
                           const Se3& base_from_camera) {
  const Se3 camera_from_base = base_from_camera.inverse();
  PoseSolution s;
  s.map_from_base = initial;
  s.is_inlier.assign(observations.size(), 1);
  for (int round = 0; round < kRounds; ++round) {
    s.converged = false;
    for (int step = 0; step < kStepsPerRound && !s.converged; ++step, ++s.iterations) {
      Normal n =
          vision_normal(observations, s.is_inlier, s.map_from_base, camera, camera_from_base);
      if (prior) add_prior(*prior, s.map_from_base, n);
      n.h.diagonal().array() += 1e-6;
      const Vector6d d = -n.h.ldlt().solve(n.g);
      if (!d.allFinite()) {
        PoseSolution failed;
        failed.map_from_base = initial;
        return failed;
      }
      s.map_from_base = retract(s.map_from_base, d);
      s.converged = d.head<3>().norm() < 1e-5 && d.tail<3>().norm() < 1e-5;
    }
    // The first rounds start far away and judge mildly.
    const double slack = round == 0 ? 9.0 : round == 1 ? 2.0 : 1.0;
    s.inliers =
        classify(observations, s.map_from_base, camera, camera_from_base, slack, s.is_inlier);
  }
  s.map_from_base = normalized(s.map_from_base);
  const Normal n =
      vision_normal(observations, s.is_inlier, s.map_from_base, camera, camera_from_base);
  s.information = n.h;
  s.gradient = n.g;
  s.pixel_rms = rms_of_inliers(observations, s, camera, camera_from_base);
  s.degenerate = is_degenerate(n.h);
  return s;
}

}  // namespace rovigo::slam
