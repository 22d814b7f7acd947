#pragma once
// How the sensors sit on the rover.

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>

namespace rovigo::slam {

/// *camera* is always the optical frame (x right, y down, z forward); p_base = base_from_camera *
/// p.
struct Rig {
  mrpt::img::TCamera camera;  ///< colour camera; depth is registered to it
  mrpt::poses::CPose3D base_from_camera;
  bool has_extrinsics = false;  ///< false: the camera is the body, the first view is taken as level
  double rolling_shutter_s = 0.0;  ///< from an image's first row to its last; 0: not known
  bool has_wheels = false;
  bool has_imu = false;
};

/// MRPT's sensor pose has x forward; ours is the optical frame. The one place that converts.
mrpt::poses::CPose3D base_from_optical(const mrpt::poses::CPose3D& base_from_mrpt_sensor);
mrpt::poses::CPose3D base_from_mrpt_sensor(const mrpt::poses::CPose3D& base_from_optical);

}  // namespace rovigo::slam
