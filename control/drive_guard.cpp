#include "control/drive_guard.h"

#include <cmath>

#include "control/pose_use.h"

namespace rovigo::control {

const char* to_string(StopCause cause) {
  switch (cause) {
    case StopCause::kNone:
      return "none";
    case StopCause::kNoPoses:
      return "no_poses";
    case StopCause::kOldPoses:
      return "poses_too_old";
    case StopCause::kBadPoses:
      return "poses_not_finite";
    case StopCause::kLostPoses:
      return "pose_lost";
    case StopCause::kNoSetPoints:
      return "no_set_points";
    case StopCause::kLowBattery:
      return "battery_low";
    case StopCause::kManual:
      return "manual_takeover";
  }
  return "unknown";
}

bool concerns_drive(StopCause cause) {
  return cause == StopCause::kNoSetPoints || cause == StopCause::kLowBattery ||
         cause == StopCause::kManual;
}

TTwist2D DriveGuard::pass(const GuardInput& in) {
  take_pose(in.now_s, in.pose);
  if (in.set_point && std::isfinite(in.set_point->vx) && std::isfinite(in.set_point->omega)) {
    set_point_ = *in.set_point;
    set_points_.feed(in.now_s);
  }
  const StopCause cause = cause_at(in);
  if (cause != StopCause::kNone && cause_ == StopCause::kNone) held_since_s_ = in.now_s;
  cause_ = cause;
  if (cause != StopCause::kNone) return {};
  return in.looks_around ? TTwist2D(0.0, 0.0, set_point_.omega) : set_point_;
}

void DriveGuard::take_pose(double now_s, const PoseInput& pose) {
  if (seen_pose_s_ && pose.time_s == *seen_pose_s_) return;  // nothing new has come
  seen_pose_s_ = pose.time_s;
  const PoseUse use = judge_pose(config_, now_s, pose);
  if (use == PoseUse::kDrive) {
    if (usable_pose_s_ && pose.time_s < *usable_pose_s_) return;  // overtaken on its way
    usable_pose_s_ = pose.time_s;
    poses_.feed(now_s);
    return;
  }
  pose_refused_ = use == PoseUse::kTooOld      ? StopCause::kOldPoses
                  : use == PoseUse::kNotFinite ? StopCause::kBadPoses
                                               : StopCause::kLostPoses;
  pose_refused_s_ = now_s;
}

StopCause DriveGuard::cause_at(const GuardInput& in) const {
  if (in.manual) return StopCause::kManual;
  if (!(in.battery_v >= battery_low_v_)) return StopCause::kLowBattery;
  if (set_points_.expired(in.now_s)) return StopCause::kNoSetPoints;
  if (in.looks_around || !poses_.expired(in.now_s)) return StopCause::kNone;
  const bool refused_lately = pose_refused_s_ && in.now_s - *pose_refused_s_ < config_.watchdog_s;
  return refused_lately ? pose_refused_ : StopCause::kNoPoses;
}

bool DriveGuard::out_of_patience(double now_s) const {
  if (cause_ == StopCause::kNone) return false;
  const double patience =
      cause_ == StopCause::kManual ? config_.takeover_patience_s : config_.pose_patience_s;
  return now_s - held_since_s_ > patience;
}

}  // namespace rovigo::control
