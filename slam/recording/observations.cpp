#include "slam/recording/observations.h"

#include <cmath>

namespace rovigo::slam {
namespace {

// 100 ns ticks between 1601-01-01, where MRPT's clock begins, and 1970-01-01.
constexpr long long kEpochTicks = 116444736000000000;
constexpr double kTicksPerSecond = 1e7;

constexpr mrpt::obs::TIMUDataIndex kRateIndices[3] = {mrpt::obs::IMU_WX, mrpt::obs::IMU_WY,
                                                      mrpt::obs::IMU_WZ};
constexpr mrpt::obs::TIMUDataIndex kForceIndices[3] = {mrpt::obs::IMU_X_ACC, mrpt::obs::IMU_Y_ACC,
                                                       mrpt::obs::IMU_Z_ACC};

}  // namespace

mrpt::Clock::time_point timestamp_from_seconds(double time_s) {
  const long long ticks = std::llround(time_s * kTicksPerSecond) + kEpochTicks;
  return mrpt::Clock::time_point(mrpt::Clock::duration(ticks));
}

mrpt::Clock::time_point timestamp_from_nanoseconds(std::uint64_t time_ns) {
  constexpr std::uint64_t kTick_ns = 100;
  const auto ticks = static_cast<long long>((time_ns + kTick_ns / 2) / kTick_ns) + kEpochTicks;
  return mrpt::Clock::time_point(mrpt::Clock::duration(ticks));
}

double seconds_of(const mrpt::obs::CObservation& observation) {
  const long long ticks = observation.timestamp.time_since_epoch().count() - kEpochTicks;
  return static_cast<double>(ticks) / kTicksPerSecond;
}

std::string time_text(const mrpt::obs::CObservation& observation) {
  constexpr long long kTicks = 10000000;
  const long long ticks = observation.timestamp.time_since_epoch().count() - kEpochTicks;
  const long long seconds = ticks / kTicks - (ticks % kTicks < 0 ? 1 : 0);
  std::string decimals = std::to_string(ticks - seconds * kTicks);
  decimals.insert(0, 7 - decimals.size(), '0');
  return std::to_string(seconds) + '.' + decimals;
}

mrpt::obs::CObservationIMU::Ptr make_imu_observation(const ImuSample& sample) {
  auto imu = mrpt::obs::CObservationIMU::Create();
  imu->sensorLabel = "imu";
  imu->timestamp = timestamp_from_seconds(sample.time_s);
  for (int axis = 0; axis < 3; ++axis) {
    imu->set(kRateIndices[axis], sample.angular_rate_rad_s[axis]);
    imu->set(kForceIndices[axis], sample.specific_force_m_s2[axis]);
  }
  return imu;
}

std::optional<ImuSample> imu_sample_of(const mrpt::obs::CObservationIMU& observation) {
  ImuSample sample;
  sample.time_s = seconds_of(observation);
  for (int axis = 0; axis < 3; ++axis) {
    if (!observation.has(kRateIndices[axis]) || !observation.has(kForceIndices[axis])) return {};
    sample.angular_rate_rad_s[axis] = observation.get(kRateIndices[axis]);
    sample.specific_force_m_s2[axis] = observation.get(kForceIndices[axis]);
  }
  if (!sample.angular_rate_rad_s.allFinite() || !sample.specific_force_m_s2.allFinite()) return {};
  const Eigen::Matrix3d base_from_imu = observation.sensorPose.getRotationMatrix().asEigen();
  sample.angular_rate_rad_s = base_from_imu * sample.angular_rate_rad_s;
  sample.specific_force_m_s2 = base_from_imu * sample.specific_force_m_s2;
  return sample;
}

mrpt::obs::CObservationOdometry::Ptr make_odometry_observation(
    const WheelSample& sample, const std::optional<WheelSample>& previous) {
  auto odometry = mrpt::obs::CObservationOdometry::Create();
  odometry->sensorLabel = "wheels";
  odometry->timestamp = timestamp_from_seconds(sample.time_s);
  odometry->odometry = mrpt::poses::CPose2D(sample.odom_from_base);
  if (!previous) return odometry;
  constexpr double kShortestStep_s = 1e-4;
  const double step_s = sample.time_s - previous->time_s;
  if (step_s < kShortestStep_s) return odometry;
  const TPose2D moved =
      maps::compose(maps::inverse(previous->odom_from_base), sample.odom_from_base);
  // The arc's frame half way turns a chord into forward and sideways speed.
  const double half_turn = 0.5 * moved.phi;
  odometry->hasVelocities = true;
  odometry->velocityLocal.vx =
      (std::cos(half_turn) * moved.x + std::sin(half_turn) * moved.y) / step_s;
  odometry->velocityLocal.vy =
      (-std::sin(half_turn) * moved.x + std::cos(half_turn) * moved.y) / step_s;
  odometry->velocityLocal.omega = moved.phi / step_s;
  return odometry;
}

mrpt::obs::CObservation3DRangeScan::Ptr make_rgbd_observation(double time_s, const Rig& rig,
                                                              float range_units_m) {
  constexpr float kMaxRange_m = 10.0F;
  auto scan = mrpt::obs::CObservation3DRangeScan::Create();
  scan->sensorLabel = "camera";
  scan->timestamp = timestamp_from_seconds(time_s);
  scan->sensorPose = base_from_mrpt_sensor(rig.base_from_camera);
  scan->cameraParams = rig.camera;
  scan->cameraParamsIntensity = rig.camera;
  scan->rangeUnits = range_units_m;
  scan->range_is_depth = true;
  scan->maxRange = kMaxRange_m;
  return scan;
}

}  // namespace rovigo::slam
