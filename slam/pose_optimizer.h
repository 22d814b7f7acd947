#pragma once
// Motion-only optimisation: the one pose that best explains matched landmarks and a prior.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "slam/camera_model.h"
#include "slam/se3.h"

namespace rovigo::slam {

/// A landmark of known place, seen at a pixel and, where the depth camera answered, a depth.
struct PointObservation {
  Eigen::Vector3d point_map = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double pixel_sigma = 1.0;
  double depth_m = 0.0;  ///< 0: none
  double depth_sigma_m = 0.0;
};

/// What is believed before looking: weight in the chart of `retract(map_from_base, .)`.
struct PosePrior6 {
  Se3 map_from_base;
  Matrix6d information = Matrix6d::Zero();
};

struct PoseSolution {
  Se3 map_from_base;
  /// Quadratic model of the vision part alone around the solution, in its own chart:
  /// cost(step) = gradient' step + step' information step / 2. The prior is not in it, so that a
  /// filter which supplied the prior may take this in without counting the prior twice.
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  std::vector<std::uint8_t> is_inlier;
  int inliers = 0;
  int iterations = 0;
  double pixel_rms = 0.0;  ///< of the inliers, in units of their sigma
  bool converged = false;
  bool degenerate = false;  ///< vision alone leaves some direction of motion open
};

/// Gauss-Newton on robust reprojection and depth errors: outliers are set aside between rounds by
/// their chi-square (95%), inliers are weighted by Huber's kernel.
PoseSolution optimize_pose(const std::vector<PointObservation>& observations, const Se3& initial,
                           const std::optional<PosePrior6>& prior, const CameraModel& camera,
                           const Se3& base_from_camera);

}  // namespace rovigo::slam
