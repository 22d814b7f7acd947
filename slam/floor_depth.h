#pragma once
// What is known of the floor, told to depths that were measured on it: a polished floor is read
// centimetres off, and neighbouring readings err together, so that no average helps; or the depth
// is that of what the floor mirrors.

#include <optional>
#include <vector>

#include "slam/camera_frame.h"
#include "slam/floor_tracker.h"
#include "slam/se3.h"

namespace rovigo::slam {

/// One frame before the floor as it is known (`FloorTracker`).
class FloorDepth {
 public:
  /// `level_from_camera`: the camera over the plane z = 0, which is as well known as `plane` says.
  /// Keeps references to the first three.
  FloorDepth(const CameraFrame& frame, const CameraModel& camera, const DepthConfig& config,
             const Se3& level_from_camera, const FloorPlane& plane);

  /// The depth at a raw pixel, in metres: as measured off the floor, none (0) below it; on it drawn
  /// towards the plane, by as much as the floor around it is read worse than the plane is known, in
  /// a frame that reads its floor unevenly. Of a plane that no look has shown yet only the first.
  double at(const Eigen::Vector2d& raw_pixel) const;

  /// How unevenly this frame reads its floor, as a share of the depth (1 sigma); 0 where it reads
  /// too little.
  double roughness() const { return roughness_; }

 private:
  double plane_at(const Eigen::Vector2d& raw_pixel) const;
  bool is_below(const Eigen::Vector2d& raw_pixel, double measured_m) const;
  double height_m(double measured_m, double plane_m) const;
  bool rises_as_floor(const Eigen::Vector2d& raw_pixel, double plane_m) const;
  std::optional<double> roughness_around(const Eigen::Vector2d& raw_pixel) const;
  void read_floor();
  double measure_roughness() const;

  const CameraFrame& frame_;
  const CameraModel& camera_;
  const DepthConfig& config_;
  Se3 level_from_camera_;
  FloorPlane plane_;
  int columns_ = 0, rows_ = 0;
  /// Of every so many pixels: depth as read over that of the plane, 0 off the floor.
  std::vector<float> ratios_;
  double roughness_ = 0.0;
};

}  // namespace rovigo::slam
