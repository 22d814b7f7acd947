#pragma once
// Cameras that read an image row by row shear it while they turn.

#include <Eigen/Core>

#include "slam/camera_model.h"
#include "slam/rig.h"
#include "slam/se3.h"
#include "slam/slam_config.h"

namespace rovigo::slam {

struct RollingShutter {
  double readout_s = 0.0;  ///< from the first row to the last; 0: all rows at once
  Eigen::Vector3d turn_rate_rad_s = Eigen::Vector3d::Zero();  ///< of the camera, optical axes
};

/// The shutter while the rover turns at `turn_rate_rad_s` (base_link). The recording knows its
/// camera best; the setting speaks for cameras it does not know.
RollingShutter rolling_shutter_of(const Rig& rig, const TrackingConfig& config,
                                  const Eigen::Vector3d& turn_rate_rad_s,
                                  const Se3& base_from_camera);

/// Where a pixel would be had the whole image been taken with its middle row: `ideal` is the pixel
/// without distortion, `raw_row` the row it was read in. Model: the camera turns evenly; what
/// moving does in that time needs depth and is small beside it.
Eigen::Vector2d at_middle_row(const Eigen::Vector2d& ideal, double raw_row,
                              const CameraModel& camera, const RollingShutter& shutter);

}  // namespace rovigo::slam
