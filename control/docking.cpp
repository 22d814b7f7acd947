#include "control/docking.h"

#include <algorithm>
#include <cmath>

#include "control/pose_use.h"

namespace rovigo::control {
namespace {

using maps::wrap_angle;

constexpr double kFadeM = 0.15;     ///< the correction across fades out over the last stretch
constexpr double kNudgeRad = 0.2;   ///< up to here a standing rover is nudged, not steered
constexpr double kStandingS = 0.4;  ///< before it is judged where the rover came to stand

DriveLimits docking_limits(const DockingConfig& config, const ControlConfig& trust,
                           const maps::RobotModel& robot) {
  DriveLimits limits = drive_limits(trust, robot);
  limits.max_reverse_speed_m_s = std::min(config.back_up_speed_m_s, limits.max_speed_m_s);
  return limits;
}

}  // namespace

DockingController::DockingController(const DockingConfig& config, const ControlConfig& trust,
                                     const maps::RobotModel& robot)
    : config_(config),
      trust_(trust),
      limits_(docking_limits(config, trust, robot)),
      along_(config.along()) {}

TrackerOutput DockingController::step(double now_s, const PoseInput& pose) {
  if (out_.status != TrackStatus::kRunning || !std::isfinite(now_s)) return out_;
  const double dt = pass_time(now_s);
  const bool usable = judge_pose(trust_, now_s, pose) == PoseUse::kDrive;
  TTwist2D wanted;
  if (usable) {
    last_usable_s_ = now_s;
    out_.cross_track_error_m = pose.map_from_base.y;
    out_.heading_error_rad = wrap_angle(-pose.map_from_base.phi);
    wanted = law(pose.map_from_base, now_s, dt);
  }
  watch_time(now_s);
  out_.command = out_.status == TrackStatus::kRunning
                     ? limited_command(wanted, out_.command, dt, limits_)
                     : TTwist2D();
  return out_;
}

TrackerOutput DockingController::hold(double now_s) {
  if (out_.status != TrackStatus::kRunning || !std::isfinite(now_s)) return out_;
  const double held_s = pass_time(now_s);
  start_s_ += held_s;
  last_usable_s_ += held_s;
  next_sample_s_ = std::max(next_sample_s_, now_s);
  standing_s_ = 0.0;
  out_.command = {};
  return out_;
}

/// Seconds since the last call.
double DockingController::pass_time(double now_s) {
  if (!started_) {
    started_ = true;
    start_s_ = last_s_ = next_sample_s_ = last_usable_s_ = now_s;
  }
  const double dt = std::max(0.0, now_s - last_s_);
  last_s_ = std::max(now_s, last_s_);
  return dt;
}

void DockingController::watch_time(double now_s) {
  if (out_.status != TrackStatus::kRunning) return;
  if (now_s - last_usable_s_ > trust_.pose_patience_s) out_.status = TrackStatus::kPoseLost;
  if (now_s - start_s_ > config_.longest_s) out_.status = TrackStatus::kTimedOut;
}

TTwist2D DockingController::law(const TPose2D& at, double now_s, double dt_s) {
  switch (phase_) {
    case Phase::kApproach:
      return approach(at, now_s);
    case Phase::kAlign:
      return align(at, dt_s);
    case Phase::kBackUp:
      return back_up(at);
  }
  return {};
}

TTwist2D DockingController::approach(const TPose2D& at, double now_s) {
  const double left = -at.x;
  if (left <= config_.along_tolerance_m) {
    phase_ = Phase::kAlign;
    return {};
  }
  if (now_s + 1e-9 >= next_sample_s_) {
    next_sample_s_ = std::max(next_sample_s_ + config_.sample_time_s, now_s);
    speed_m_s_ = std::max(0.0, along_.update(left));
  }
  const double fade = std::clamp(left / kFadeM, 0.0, 1.0);
  const double towards_axis =
      -std::clamp(std::atan(config_.approach_gain_1_m * at.y) * fade,
                  -config_.max_approach_angle_rad, config_.max_approach_angle_rad);
  const double heading_error = wrap_angle(towards_axis - at.phi);
  const bool turns_first = std::abs(heading_error) > config_.turn_first_angle_rad;
  return {turns_first ? 0.0 : speed_m_s_ * std::cos(heading_error), 0.0, turn_rate(heading_error)};
}

TTwist2D DockingController::align(const TPose2D& at, double dt_s) {
  const double error = wrap_angle(-at.phi);
  if (nudge_.is_pushing() || std::abs(error) > config_.heading_tolerance_rad) {
    standing_s_ = 0.0;
    if (std::abs(error) > kNudgeRad) return {0.0, 0.0, turn_rate(error)};
    return {0.0, 0.0, nudge_.step(error, dt_s, trust_.dead_zone_speed_m_s, 1.0, limits_)};
  }
  standing_s_ += dt_s;
  if (standing_s_ < kStandingS) return {};
  standing_s_ = 0.0;
  nudge_.reset();
  if (std::abs(at.y) <= config_.across_tolerance_m &&
      std::abs(at.x) <= 2.0 * config_.along_tolerance_m) {
    out_.status = TrackStatus::kReached;
  } else if (attempts_ >= config_.most_attempts) {
    out_.status = TrackStatus::kNoProgress;
  } else {
    phase_ = Phase::kBackUp;
  }
  return {};
}

TTwist2D DockingController::back_up(const TPose2D& at) {
  if (at.x <= -config_.back_up_m) {
    ++attempts_;
    along_ = SwitchingPi(config_.along());
    phase_ = Phase::kApproach;
    return {};
  }
  return {-config_.back_up_speed_m_s, 0.0, turn_rate(wrap_angle(-at.phi))};
}

double DockingController::turn_rate(double heading_error) const {
  return std::clamp(config_.heading_gain_1_s * heading_error, -config_.max_turn_rate_rad_s,
                    config_.max_turn_rate_rad_s);
}

}  // namespace rovigo::control
