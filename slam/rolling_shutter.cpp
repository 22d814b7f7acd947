#include "slam/rolling_shutter.h"

#include "slam/se3.h"

namespace rovigo::slam {

RollingShutter rolling_shutter_of(const Rig& rig, const TrackingConfig& config,
                                  const Eigen::Vector3d& turn_rate_rad_s,
                                  const Se3& base_from_camera) {
  const double known_s = rig.rolling_shutter_s;
  return {known_s > 0.0 ? known_s : config.rolling_shutter_s,
          base_from_camera.rotation.transpose() * turn_rate_rad_s};
}

Eigen::Vector2d at_middle_row(const Eigen::Vector2d& ideal, double raw_row,
                              const CameraModel& camera, const RollingShutter& shutter) {
  if (shutter.readout_s == 0.0) return ideal;
  const double late_s = ((raw_row + 0.5) / camera.height() - 0.5) * shutter.readout_s;
  const Eigen::Vector3d ray =
      so3_exp(shutter.turn_rate_rad_s * late_s) * camera.unproject(ideal, 1.0);
  return ray.z() > 0 ? camera.project(ray) : ideal;
}

}  // namespace rovigo::slam
