#pragma once
// The drive side's last word before the motors: it knows nothing of trajectories, only whether the
// rover may move at all. Time is an argument.

#include <optional>

#include "control/control_config.h"
#include "control/drive_controller.h"
#include "control/watchdog.h"

namespace rovigo::control {

/// Why the drive side holds the rover.
enum class StopCause {
  kNone,
  kNoPoses,      ///< none arrives
  kOldPoses,     ///< they are too old when they arrive
  kBadPoses,     ///< they are not finite, or of no sensible time
  kLostPoses,    ///< they say that nobody knows where the rover is
  kNoSetPoints,  ///< whoever steers has fallen silent, or sends no numbers
  kLowBattery,
  kManual,  ///< an operator has taken over
};

const char* to_string(StopCause cause);

/// True for the causes that whoever steers cannot see by itself.
bool concerns_drive(StopCause cause);

struct GuardInput {
  double now_s = 0.0;
  PoseInput pose;                     ///< the newest that arrived
  std::optional<TTwist2D> set_point;  ///< what arrived since the last call, if anything did
  double battery_v = 0.0;
  bool manual = false;        ///< an operator holds the rover
  bool looks_around = false;  ///< to find its pose: it needs none, and may turn on the spot only
};

/// Passes set-points on, or zero: at once on a low battery or a manual takeover, and `watchdog_s`
/// after the last usable pose or set-point. Goes on as soon as all is well again.
class DriveGuard {
 public:
  DriveGuard(const ControlConfig& config, double battery_low_v)
      : config_(config),
        battery_low_v_(battery_low_v),
        poses_(config.watchdog_s),
        set_points_(config.watchdog_s) {}

  /// The command for the motors.
  TTwist2D pass(const GuardInput& in);

  StopCause cause() const { return cause_; }
  /// True once the rover has been held for longer than it is worth waiting.
  bool out_of_patience(double now_s) const;

 private:
  void take_pose(double now_s, const PoseInput& pose);
  StopCause cause_at(const GuardInput& in) const;

  ControlConfig config_;
  double battery_low_v_;
  Watchdog poses_;
  Watchdog set_points_;
  std::optional<double> seen_pose_s_;    ///< stamp of the newest pose, usable or not
  std::optional<double> usable_pose_s_;  ///< and of the newest usable one
  StopCause pose_refused_ = StopCause::kNoPoses;
  std::optional<double> pose_refused_s_;  ///< when the last one came that was refused
  TTwist2D set_point_;
  StopCause cause_ = StopCause::kNone;
  double held_since_s_ = 0.0;
};

}  // namespace rovigo::control
