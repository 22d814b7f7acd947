#include "sim/drive_train.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rovigo::sim {
namespace {

// Turning scrubs the tyres and holds the wheels back by a few percent; the loop's integral action
// takes that out.
constexpr double kTrimRate_1_s = 10.0;
constexpr double kMaxTrim_m_s = 0.05;
constexpr double kMovingRad_s = 0.05;     // a wheel slower than this is at rest
constexpr double kKeepMovingShare = 0.4;  // of the dead zone: kinetic friction is the smaller one

}  // namespace

DriveTrain::DriveTrain(const MotorModel& motor, const WheelNoise& wheels,
                       const maps::RobotModel& robot, std::uint64_t seed)
    : motor_(motor), wheels_(wheels), robot_(robot), slip_random_(seed) {
  update_slip(0.0);
}

DriveTrain::Output DriveTrain::step(double time_s, double dt_s, const TTwist2D& command,
                                    double left_speed_rad_s, double right_speed_rad_s) {
  delayed_.emplace_back(time_s + motor_.command_latency_s, command);
  while (delayed_.size() > 1 && delayed_[1].first <= time_s) delayed_.erase(delayed_.begin());
  TTwist2D twist;
  if (delayed_.front().first <= time_s) twist = delayed_.front().second;
  if (!std::isfinite(twist.vx) || !std::isfinite(twist.omega)) twist = {};

  update_slip(time_s);
  const bool slipping = time_s < slip_end_s_;
  Output out;
  out.left_grip = slipping && slip_on_left_ ? slip_grip_ : 1.0;
  out.right_grip = slipping && !slip_on_left_ ? slip_grip_ : 1.0;
  const double half_turn = 0.5 * twist.omega * robot_.track_width_m;
  out.left = drive_side(twist.vx - half_turn, left_speed_rad_s, out.left_grip, dt_s, left_loop_);
  out.right =
      drive_side(twist.vx + half_turn, right_speed_rad_s, out.right_grip, dt_s, right_loop_);
  return out;
}

SideDrive DriveTrain::drive_side(double target_m_s, double measured_rad_s, double grip, double dt_s,
                                 SpeedLoop& loop) const {
  const double limit = motor_.no_load_speed_m_s;
  double target = std::clamp(target_m_s, -limit, limit);
  const bool moving = std::abs(measured_rad_s) > kMovingRad_s;
  const double threshold = motor_.dead_zone_m_s * (moving ? kKeepMovingShare : 1.0);
  if (std::abs(target) < threshold) target = 0.0;
  loop.wanted_m_s +=
      (target - loop.wanted_m_s) * std::min(1.0, dt_s / std::max(motor_.lag_s, dt_s));
  const double measured_m_s = measured_rad_s * robot_.wheel_radius_m;
  const double error = grip * loop.wanted_m_s - measured_m_s;
  loop.trim_m_s = target == 0.0 ? 0.0
                                : std::clamp(loop.trim_m_s + kTrimRate_1_s * error * dt_s,
                                             -kMaxTrim_m_s, kMaxTrim_m_s);
  SideDrive drive;
  drive.speed_rad_s = (grip * loop.wanted_m_s + loop.trim_m_s) / robot_.wheel_radius_m;
  // A DC motor's torque falls linearly from stall to the no-load speed; braking it has all of it.
  const double rim_m_s = std::abs(measured_m_s);
  const bool accelerating = std::abs(drive.speed_rad_s) > std::abs(measured_rad_s);
  const double share = accelerating ? std::clamp(1.0 - rim_m_s / limit, 0.0, 1.0) : 1.0;
  drive.torque_limit_nm = motor_.stall_torque_nm * share;
  return drive;
}

/// Slips come as a Poisson process; each takes one side, drawn anew.
void DriveTrain::update_slip(double time_s) {
  if (wheels_.slip_events_per_minute <= 0.0 || time_s < next_slip_s_) return;
  const bool first = next_slip_s_ == 0.0;
  if (!first) {
    slip_on_left_ = slip_random_.uniform(0.0, 1.0) < 0.5;
    slip_grip_ = 1.0 - slip_random_.uniform(wheels_.slip_min, wheels_.slip_max);
    slip_end_s_ = time_s + slip_random_.uniform(0.25, 1.0) * wheels_.slip_max_duration_s;
  }
  const double mean_s = 60.0 / wheels_.slip_events_per_minute;
  const double gap_s = -mean_s * std::log(1.0 - slip_random_.uniform(0.0, 1.0));
  next_slip_s_ = std::max(time_s, slip_end_s_) + gap_s + 1e-6;
}

}  // namespace rovigo::sim
