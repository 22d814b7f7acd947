#pragma once
// Walls against walls: where a plain corridor shows the camera no corner to hold on to, its walls
// still say how far off they are and which way they run (point-to-line ICP: Censi 2008). Along the
// corridor they say nothing, and the information says so.

#include <Eigen/Core>
#include <vector>

#include "slam/camera_frame.h"
#include "slam/planar_information.h"
#include "slam/se3.h"

namespace rovigo::slam {

/// Where an image column meets an upright surface.
struct WallPoint {
  Eigen::Vector2f point = Eigen::Vector2f::Zero();  ///< over the floor, in base_link
  /// Unit, towards who saw it; zero where no line fits.
  Eigen::Vector2f normal = Eigen::Vector2f::Zero();
  float sigma_m = 0.0f;         ///< along the ray
  float sigma_across_m = 0.0f;  ///< across the surface
};
using WallScan = std::vector<WallPoint>;

/// The surfaces at obstacle height in every few image columns, left to right.
WallScan wall_scan(const CameraFrame& frame, const CameraModel& camera, const Se3& base_from_camera,
                   const SlamConfig& config);

struct WallMatch {
  PlanarInformation look;  ///< the walls' own word on the pose, without the prior's
  int points = 0;          ///< that found a wall of the reference
  double inlier_share = 0.0;
};

/// A scan made earlier, and where.
struct PlacedWalls {
  const WallScan* scan = nullptr;
  TPose2D map_from_base;
};

/// Points of `other` beside a point of `one` on the same face of a wall.
int common_points(const PlacedWalls& one, const PlacedWalls& other);

/// Gauss-Newton from the prior pose; the prior holds the directions the walls say nothing about.
WallMatch match_walls(const std::vector<PlacedWalls>& reference, const WallScan& scan,
                      const TPose2D& prior, const Eigen::Matrix3d& prior_covariance);

}  // namespace rovigo::slam
