#include "control/command_limiter.h"

#include <algorithm>
#include <cmath>

namespace rovigo::control {
namespace {

double slewed(double from, double to, double largest_change) {
  return from + std::clamp(to - from, -largest_change, largest_change);
}

/// The rim speed is |v| + |omega| * half the track: what is left of it for the other of the two.
double speed_left(double yaw_rate, const DriveLimits& limits) {
  return std::max(0.0, limits.max_wheel_speed_m_s - std::abs(yaw_rate) * limits.track_width_m / 2);
}

double yaw_rate_left(double speed, const DriveLimits& limits) {
  return std::max(0.0, 2 * (limits.max_wheel_speed_m_s - std::abs(speed)) / limits.track_width_m);
}

}  // namespace

double faster_wheel(const TTwist2D& twist, double track_width_m) {
  return std::abs(twist.vx) + std::abs(twist.omega) * track_width_m / 2;
}

DriveLimits drive_limits(const ControlConfig& config, const maps::RobotModel& robot) {
  DriveLimits limits;
  limits.max_speed_m_s = std::min(robot.max_speed_m_s, config.max_wheel_speed_m_s);
  limits.track_width_m = robot.track_width_m;
  limits.max_wheel_speed_m_s = config.max_wheel_speed_m_s;
  limits.max_yaw_rate_rad_s = std::min(robot.max_yaw_rate_rad_s, yaw_rate_left(0.0, limits));
  limits.max_acceleration_m_s2 = robot.max_acceleration_m_s2;
  limits.max_yaw_acceleration_rad_s2 = robot.max_yaw_acceleration_rad_s2;
  return limits;
}

TTwist2D limited_command(const TTwist2D& desired, const TTwist2D& last, double dt_s,
                         const DriveLimits& limits) {
  constexpr double kLongestStepS = 0.1;
  const double dt = dt_s > 0.0 ? std::min(dt_s, kLongestStepS) : 0.0;
  const bool usable = std::isfinite(desired.vx) && std::isfinite(desired.omega);

  const double yaw_rate_wanted = std::clamp(usable ? desired.omega : 0.0,
                                            -limits.max_yaw_rate_rad_s, limits.max_yaw_rate_rad_s);
  const double speed_wanted =
      std::clamp(usable ? desired.vx : 0.0,
                 -std::min(limits.max_reverse_speed_m_s, speed_left(yaw_rate_wanted, limits)),
                 std::min(limits.max_speed_m_s, speed_left(yaw_rate_wanted, limits)));

  double speed = slewed(last.vx, speed_wanted, limits.max_acceleration_m_s2 * dt);
  // Speeding up must not take the rim speed that turning uses now.
  const double left = speed_left(last.omega, limits);
  if (speed > last.vx) speed = std::max(last.vx, std::min(speed, left));
  if (speed < last.vx) speed = std::min(last.vx, std::max(speed, -left));
  double yaw_rate = slewed(last.omega, yaw_rate_wanted, limits.max_yaw_acceleration_rad_s2 * dt);
  const double most = yaw_rate_left(speed, limits);
  yaw_rate = std::clamp(yaw_rate, -most, most);
  return {speed, 0.0, yaw_rate};
}

TTwist2D with_dead_zone_compensation(const TTwist2D& desired, double standing_s,
                                     double dead_zone_m_s, double track_width_m) {
  constexpr double kWorthwhile = 0.1;  // of the dead zone: less is standstill
  constexpr double kSurelyStandingS = 0.15;
  const double wanted = faster_wheel(desired, track_width_m);
  if (!(dead_zone_m_s > 0.0) || wanted >= dead_zone_m_s || wanted < kWorthwhile * dead_zone_m_s ||
      standing_s < kSurelyStandingS) {
    return desired;
  }
  const double factor = dead_zone_m_s / wanted;
  return {desired.vx * factor, 0.0, desired.omega * factor};
}

}  // namespace rovigo::control
