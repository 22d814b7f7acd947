#pragma once
// Cameras that read an image row by row shear it while they turn.

#include <Eigen/Core>

#include "slam/camera_model.h"

namespace rovigo::slam {

struct RollingShutter {
  double readout_s = 0.0;  ///< from the first row to the last; 0: all rows at once
  Eigen::Vector3d turn_rate_rad_s = Eigen::Vector3d::Zero();  ///< of the camera, optical axes
};

/// Where a pixel would be had the whole image been taken with its middle row: `ideal` is the pixel
/// without distortion, `raw_row` the row it was read in. Model: the camera turns evenly; what
/// moving does in that time needs depth and is small beside it.
Eigen::Vector2d at_middle_row(const Eigen::Vector2d& ideal, double raw_row,
                              const CameraModel& camera, const RollingShutter& shutter);

}  // namespace rovigo::slam
