#include "sim/body_sensors.h"

#include <cmath>

namespace rovigo::sim {

ImuSensor::ImuSensor(const ImuNoise& noise, const Eigen::Vector3d& gravity, std::uint64_t seed)
    : noise_(noise), gravity_(gravity), random_(seed) {
  for (int i = 0; i < 3; ++i) {
    gyro_bias_[i] = random_.uniform(-1.0, 1.0) * noise.gyro_bias_max_rad_s;
    accelerometer_bias_[i] = random_.uniform(-1.0, 1.0) * noise.accelerometer_bias_max_m_s2;
  }
}

void ImuSensor::advance(const BodyState& state) {
  summed_rate_ += state.world_from_base.linear().transpose() * state.angular_velocity;
  ++summed_steps_;
}

mrpt::obs::CObservationIMU::Ptr ImuSensor::sample(const BodyState& state, double interval_s) {
  const Eigen::Matrix3d base_from_world = state.world_from_base.linear().transpose();
  const Eigen::Vector3d acceleration = (state.velocity - previous_velocity_) / interval_s;
  previous_velocity_ = state.velocity;
  Eigen::Vector3d force = base_from_world * (acceleration - gravity_);
  Eigen::Vector3d rate = base_from_world * state.angular_velocity;
  if (summed_steps_ > 0) rate = summed_rate_ / summed_steps_;
  summed_rate_.setZero();
  summed_steps_ = 0;
  for (int i = 0; i < 3; ++i) {
    rate[i] += gyro_bias_[i] + noise_.gyro_sigma_rad_s * random_.gaussian();
    force[i] += accelerometer_bias_[i] + noise_.accelerometer_sigma_m_s2 * random_.gaussian();
    gyro_bias_[i] += noise_.gyro_walk_rad_s_per_sqrt_s * std::sqrt(interval_s) * random_.gaussian();
  }
  auto obs = mrpt::obs::CObservationIMU::Create();
  obs->sensorLabel = "imu";
  obs->set(mrpt::obs::IMU_WX, rate.x());
  obs->set(mrpt::obs::IMU_WY, rate.y());
  obs->set(mrpt::obs::IMU_WZ, rate.z());
  obs->set(mrpt::obs::IMU_X_ACC, force.x());
  obs->set(mrpt::obs::IMU_Y_ACC, force.y());
  obs->set(mrpt::obs::IMU_Z_ACC, force.z());
  return obs;
}

WheelSensor::WheelSensor(const WheelNoise& noise, const maps::RobotModel& robot, std::uint64_t seed)
    : noise_(noise), robot_(robot) {
  RandomStream random(seed);
  speed_scale_ = 1.0 + random.uniform(-1.0, 1.0) * noise.scale_error_max;
  turn_scale_ = 1.0 + random.uniform(-1.0, 1.0) * noise.track_error_max;
}

void WheelSensor::advance(double left_rad, double right_rad) {
  // Errors of radius and track, expressed as what the encoders would count.
  const double mean = 0.5 * (left_rad + right_rad) * speed_scale_;
  const double half_difference = 0.5 * (right_rad - left_rad) * turn_scale_;
  left_rad_ += mean - half_difference;
  right_rad_ += mean + half_difference;
}

mrpt::obs::CObservationOdometry::Ptr WheelSensor::sample(double interval_s) {
  const double rad_per_tick = 2.0 * maps::kPi / noise_.ticks_per_turn;
  const auto left_ticks = static_cast<long>(std::floor(left_rad_ / rad_per_tick));
  const auto right_ticks = static_cast<long>(std::floor(right_rad_ / rad_per_tick));
  const double m_per_tick = rad_per_tick * robot_.wheel_radius_m;
  const double left_m = static_cast<double>(left_ticks - left_ticks_) * m_per_tick;
  const double right_m = static_cast<double>(right_ticks - right_ticks_) * m_per_tick;
  left_ticks_ = left_ticks;
  right_ticks_ = right_ticks;
  const double forward = 0.5 * (left_m + right_m);
  const double turn = (right_m - left_m) / robot_.track_width_m;
  const double middle = odom_from_base_.phi + 0.5 * turn;
  odom_from_base_ = {odom_from_base_.x + forward * std::cos(middle),
                     odom_from_base_.y + forward * std::sin(middle),
                     maps::wrap_angle(odom_from_base_.phi + turn)};
  auto obs = mrpt::obs::CObservationOdometry::Create();
  obs->sensorLabel = "wheels";
  obs->odometry = mrpt::poses::CPose2D(odom_from_base_);
  obs->hasEncodersInfo = true;
  obs->encoderLeftTicks = static_cast<std::int32_t>(left_ticks);
  obs->encoderRightTicks = static_cast<std::int32_t>(right_ticks);
  obs->hasVelocities = true;
  obs->velocityLocal = TTwist2D(forward / interval_s, 0.0, turn / interval_s);
  return obs;
}

}  // namespace rovigo::sim
