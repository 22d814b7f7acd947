#pragma once
// Was the rover carried off between two frames? What the camera measured a moment ago must be seen
// again from where wheels and gyro have led since, texture or not.

#include <optional>

#include "slam/camera_frame.h"
#include "slam/depth_sample.h"

namespace rovigo::slam {

class ViewContinuity {
 public:
  ViewContinuity(const CameraModel& camera, const Se3& base_from_camera)
      : camera_(camera), base_from_camera_(base_from_camera) {}

  /// Takes in a frame with the pose believed for it. True if its depth image goes on from the last
  /// frame's; false also where that cannot be told (a gap, no returns).
  bool follows(const CameraFrame& frame, const Se3& map_from_base);

 private:
  struct Last {
    double time_s = 0.0;
    Se3 map_from_camera;
    std::vector<Eigen::Vector3f> points;
  };
  CameraModel camera_;
  Se3 base_from_camera_;
  std::optional<Last> last_;
};

}  // namespace rovigo::slam
