#include "control/turn_nudge.h"

#include <algorithm>
#include <cmath>

namespace rovigo::control {

namespace {

constexpr double kShare = 0.7;         // of the error: what stiction takes is known roughly only
constexpr double kSurelyMoving = 1.1;  // of the dead zone
constexpr double kStarting = 1.05;     // of it: the peak of the smallest push
/// Rising to the dead zone and falling from what keeps a wheel moving, the rim stands: in units of
/// the dead zone's rate squared by the acceleration.
constexpr double kLostInRamps = 0.5 + 0.5 * 0.4 * 0.4;

}  // namespace

double TurnNudge::step(double error_rad, double dt_s, double dead_zone_m_s, double turn_gain,
                       const DriveLimits& limits) {
  if (push_s_ > 0.0) {
    push_s_ -= dt_s;
    wait_s_ = kWaitS;
    return push_s_ > 0.0 ? rate_rad_s_ : 0.0;
  }
  wait_s_ -= dt_s;
  if (wait_s_ > 0.0) return 0.0;
  const double acceleration = limits.max_yaw_acceleration_rad_s2;
  const double dead_rate = 2.0 * dead_zone_m_s / limits.track_width_m;
  const double rate =
      std::clamp(kSurelyMoving * dead_rate, 0.1, std::max(0.1, limits.max_yaw_rate_rad_s));
  const double area = kShare * std::abs(error_rad) / turn_gain +
                      kLostInRamps * dead_rate * dead_rate / acceleration;
  // Under the acceleration limit the rate is a trapezoid, or for little a triangle.
  const bool triangle = area < rate * rate / acceleration;
  const double start_s = kStarting * dead_rate / acceleration;  // a shorter push moves nothing
  push_s_ = triangle ? std::max(std::sqrt(area / acceleration), start_s) : area / rate;
  rate_rad_s_ = std::copysign(triangle ? limits.max_yaw_rate_rad_s : rate, error_rad);
  return rate_rad_s_;
}

}  // namespace rovigo::control
