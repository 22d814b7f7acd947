#pragma once
// Where the floor is under the camera: the mount's nominal tilt and height, corrected by the floor
// that depth images show.

#include <Eigen/Core>

#include "slam/depth_scan.h"

namespace rovigo::slam {

struct FloorTrackerConfig {
  double mount_height_sigma_m = 0.02;  ///< how far the camera may be off its nominal height
  double mount_tilt_sigma_rad = 0.03;
  double height_walk_m = 0.0003;  ///< change from one look to the next: tyres, rocking
  double tilt_walk_rad = 0.0005;
  int min_points = 40;  ///< fewer floor points say nothing
};

/// The floor as a plane z = height + slope_x x + slope_y y in the level frame that the nominal
/// extrinsics give.
struct FloorPlane {
  double height_m = 0.0;
  double slope_x = 0.0, slope_y = 0.0;
  double sigma_height_m = 0.0, sigma_tilt_rad = 0.0;  ///< 1 sigma
  int looks = 0;                                      ///< that showed enough floor
};

/// A Kalman filter over the plane with the mount as its prior; each look is a robust least-squares
/// fit (Tukey's biweight, iterated) to the returns near where the floor must be, so that things
/// lying about, mirrored returns from below and stray noise pull on it little or not at all.
class FloorTracker {
 public:
  explicit FloorTracker(const FloorTrackerConfig& config = {});

  /// Takes in a scan that was made with `corrected(...)`.
  void update(const DepthScan& scan);

  const FloorPlane& plane() const { return plane_; }

  /// The nominal pose of a camera in the level frame, brought upright over the true floor.
  Se3 corrected(const Se3& nominal_level_from_camera) const;

 private:
  FloorTrackerConfig config_;
  FloorPlane plane_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace rovigo::slam
