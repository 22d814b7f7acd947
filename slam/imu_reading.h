#pragma once
// What an IMU says of the body it is mounted on.

#include <mrpt/obs/CObservationIMU.h>

#include <Eigen/Core>
#include <optional>

namespace rovigo::slam {

struct ImuReading {
  std::optional<Eigen::Vector3d> rate_rad_s;           ///< in base_link
  std::optional<Eigen::Vector3d> specific_force_m_s2;  ///< in base_link; +9.81 upwards at rest
};

/// Turns a reading from the sensor's axes into those of base_link, and takes off what turning
/// adds to the force at the sensor's place (steady part). Non-finite readings are left out.
ImuReading imu_in_base(const mrpt::obs::CObservationIMU& imu);

}  // namespace rovigo::slam
