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

DriveTrain::Output DriveTrain::step(const Input& in) {
  update_slip(in.time_s);
  const bool slipping = in.time_s < slip_end_s_;
  Output out;
  out.left_grip = slipping && slip_on_left_ ? slip_grip_ : 1.0;
  out.right_grip = slipping && !slip_on_left_ ? slip_grip_ : 1.0;
  const double half_turn = 0.5 * in.command.omega * robot_.track_width_m;
  out.left =
      drive_side(in, in.command.vx - half_turn, in.left_speed_rad_s, out.left_grip, left_loop_);
  out.right =
      drive_side(in, in.command.vx + half_turn, in.right_speed_rad_s, out.right_grip, right_loop_);
  return out;
}

SideDrive DriveTrain::drive_side(const Input& in, double target_m_s, double measured_rad_s,
                                 double grip, SpeedLoop& loop) const {
  const double limit = robot_.motor_no_load_speed_m_s;
  double target = std::clamp(target_m_s, -limit, limit);
  const bool moving = std::abs(measured_rad_s) > kMovingRad_s;
  const double threshold = motor_.dead_zone_m_s * (moving ? kKeepMovingShare : 1.0);
  if (std::abs(target) < threshold) target = 0.0;
  loop.wanted_m_s +=
      (target - loop.wanted_m_s) * std::min(1.0, in.dt_s / std::max(motor_.lag_s, in.dt_s));
  const double measured_m_s = measured_rad_s * robot_.wheel_radius_m;
  const double error = grip * loop.wanted_m_s - measured_m_s;
  // At rest the integral holds the place; on the way to rest it has nothing to take out.
  const bool stopping = target == 0.0 && moving;
  loop.trim_m_s = stopping ? 0.0
                           : std::clamp(loop.trim_m_s + kTrimRate_1_s * error * in.dt_s,
                                        -kMaxTrim_m_s, kMaxTrim_m_s);
  SideDrive drive;
  drive.speed_rad_s = (grip * loop.wanted_m_s + loop.trim_m_s) / robot_.wheel_radius_m;
  const bool driving = std::abs(drive.speed_rad_s) > std::abs(measured_rad_s);
  drive.torque_limit_nm = motor_torque_nm(std::abs(measured_m_s), driving, in.voltage_share);
  drive.friction_nm = motor_.friction_nm;
  return drive;
}

/// The most it can do. A DC motor's torque falls linearly from stall to the no-load speed, and its
/// voltage moves that line in parallel; braking it has all of its stall torque.
double DriveTrain::motor_torque_nm(double rim_m_s, bool driving, double voltage_share) const {
  const double lost = driving ? rim_m_s / robot_.motor_no_load_speed_m_s : 0.0;
  return robot_.motor_stall_torque_nm * std::max(0.0, voltage_share - lost);
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
