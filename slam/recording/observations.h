#pragma once
// Plain sensor values as MRPT observations, and back. One place knows the indices and units.

#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "maps/geometry.h"
#include "slam/rig.h"

namespace rovigo::slam {

/// Seconds to MRPT's 100 ns ticks, rounded to the nearest (mrpt::Clock::fromDouble cuts off, so
/// that a time written and read again would lose a tick).
mrpt::Clock::time_point timestamp_from_seconds(double time_s);
/// Nanoseconds since 1970, as ROS stamps its messages, to the nearest tick.
mrpt::Clock::time_point timestamp_from_nanoseconds(std::uint64_t time_ns);
double seconds_of(const mrpt::obs::CObservation& observation);
/// The time in seconds with all seven decimals, exact where a double is not.
std::string time_text(const mrpt::obs::CObservation& observation);

/// A gyro and accelerometer sample in base_link: rad/s; specific force in m/s^2 (+9.81 up at rest).
struct ImuSample {
  double time_s = 0.0;
  Eigen::Vector3d angular_rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();
};

/// The wheels' idea of where base_link is in odom.
struct WheelSample {
  double time_s = 0.0;
  TPose2D odom_from_base;
};

mrpt::obs::CObservationIMU::Ptr make_imu_observation(const ImuSample& sample);

/// The sample in base_link (the observation's sensor pose turns it); empty unless all three rates
/// and all three forces are there and finite. Lever arms are not corrected.
std::optional<ImuSample> imu_sample_of(const mrpt::obs::CObservationIMU& observation);

/// With the local velocity since `previous`, when there is one and time has passed since.
mrpt::obs::CObservationOdometry::Ptr make_odometry_observation(
    const WheelSample& sample, const std::optional<WheelSample>& previous);

/// An RGB-D observation without images: camera models, sensor pose, depth unit.
mrpt::obs::CObservation3DRangeScan::Ptr make_rgbd_observation(double time_s, const Rig& rig,
                                                              float range_units_m);

}  // namespace rovigo::slam
