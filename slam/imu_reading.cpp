#include "slam/imu_reading.h"

#include <Eigen/Geometry>

#include "slam/se3.h"

namespace rovigo::slam {

ImuReading imu_in_base(const mrpt::obs::CObservationIMU& imu) {
  using namespace mrpt::obs;
  ImuReading out;
  const Se3 base_from_sensor = from_mrpt(imu.sensorPose);
  if (imu.has(IMU_WX) && imu.has(IMU_WY) && imu.has(IMU_WZ)) {
    const Eigen::Vector3d rate(imu.get(IMU_WX), imu.get(IMU_WY), imu.get(IMU_WZ));
    if (rate.allFinite()) out.rate_rad_s = base_from_sensor.rotation * rate;
  }
  if (imu.has(IMU_X_ACC) && imu.has(IMU_Y_ACC) && imu.has(IMU_Z_ACC)) {
    const Eigen::Vector3d force(imu.get(IMU_X_ACC), imu.get(IMU_Y_ACC), imu.get(IMU_Z_ACC));
    Eigen::Vector3d at_base = base_from_sensor.rotation * force;
    if (out.rate_rad_s) {
      at_base -= out.rate_rad_s->cross(out.rate_rad_s->cross(base_from_sensor.translation));
    }
    if (at_base.allFinite()) out.specific_force_m_s2 = at_base;
  }
  return out;
}

}  // namespace rovigo::slam
