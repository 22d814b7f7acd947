#include "control/reference_controller.h"

#include <algorithm>
#include <cmath>

namespace rovigo::control {

void ReferenceConfig::describe(maps::SettingsVisitor& v) {
  v.real({.name = "heading_kp", .help = "Proportional gain, heading.", .min = 0.0, .max = 20.0},
         heading_kp);
  v.real(
      {.name = "heading_ki", .help = "Integral gain, heading, per call.", .min = 0.0, .max = 1.0},
      heading_ki);
  v.real({.name = "speed_kp", .help = "Proportional gain, speed.", .min = 0.0, .max = 20.0},
         speed_kp);
  v.real({.name = "speed_ki", .help = "Integral gain, speed, per call.", .min = 0.0, .max = 1.0},
         speed_ki);
  v.real({.name = "integral_limit",
          .help = "Largest size of either integrator.",
          .min = 0.0,
          .max = 100.0},
         integral_limit);
  v.real({.name = "max_speed_m_s", .help = "Highest speed.", .min = 0.05, .max = 0.8},
         max_speed_m_s);
  v.real({.name = "max_yaw_rate_rad_s", .help = "Highest turn rate.", .min = 0.05, .max = 3.0},
         max_yaw_rate_rad_s);
  v.real({.name = "waypoint_tolerance_m",
          .help = "Distance at which a waypoint counts as passed.",
          .min = 0.01,
          .max = 1.0},
         waypoint_tolerance_m);
  v.real({.name = "turn_first_angle_rad",
          .help = "Heading error beyond which it only turns.",
          .min = 0.0,
          .max = 10.0},
         turn_first_angle_rad);
  v.integer({.name = "skipped_points",
             .help = "Points left out at the beginning of the path.",
             .min = 0,
             .max = 1000},
            skipped_points);
}

double ReferenceController::Pi::update(double error) {
  integral = std::clamp(ki * (error + integral), -limit, limit);
  return kp * error + integral;
}

ReferenceController::ReferenceController(const ReferenceConfig& config, std::vector<TPoint2D> path)
    : config_(config),
      path_(std::move(path)),
      waypoint_(static_cast<std::size_t>(std::max(config.skipped_points, 0))),
      heading_{config.heading_kp, config.heading_ki, config.integral_limit},
      speed_{config.speed_kp, config.speed_ki, config.integral_limit} {}

ReferenceController::Output ReferenceController::step(const TPose2D& pose) {
  Output out;
  out.waypoint = waypoint_;
  if (waypoint_ + 1 >= path_.size()) {  // the last point is left out
    out.finished = true;
    return out;
  }
  const TPoint2D target = path_[waypoint_];
  const double dx = target.x - pose.x, dy = target.y - pose.y;
  out.heading_error_rad = pose.phi - std::atan2(dy, dx);
  const double sign = dx > 0.0 ? 1.0 : (dx < 0.0 ? -1.0 : 0.0);
  out.position_error_m = sign * std::hypot(dx, dy);

  const double turn = heading_.update(-out.heading_error_rad);
  const double speed = speed_.update(out.position_error_m);
  out.command.omega = std::clamp(turn, -config_.max_yaw_rate_rad_s, config_.max_yaw_rate_rad_s);
  out.command.vx = std::clamp(speed, -config_.max_speed_m_s, config_.max_speed_m_s);
  if (std::abs(out.heading_error_rad) > config_.turn_first_angle_rad) out.command.vx = 0.0;
  if (std::abs(out.position_error_m) < config_.waypoint_tolerance_m) ++waypoint_;
  return out;
}

}  // namespace rovigo::control
