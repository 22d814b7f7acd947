#pragma once
// Brings a rover to a stop at a wanted pose that a marker shows, heading included (mission F8).

#include "control/command_limiter.h"
#include "control/docking_config.h"
#include "control/drive_controller.h"
#include "control/turn_nudge.h"

namespace rovigo::control {

/// Drives in the dock's frame: origin where base_link is to stop, x ahead, towards the marker. The
/// rover is to begin behind it (x below 0), facing it. Speed comes from the switching PI over the
/// way left; heading steers to the dock's axis. Standing there, it turns to the dock's heading; too
/// far beside the axis, which a differential drive cannot mend on the spot, it backs up and comes
/// in again. Docked is kReached; as many attempts in vain as there may be, kNoProgress.
class DockingController final : public DriveController {
 public:
  DockingController(const DockingConfig& config, const ControlConfig& trust,
                    const maps::RobotModel& robot);

  /// `pose`: dock_from_base. To be called more often than the PI's sample time.
  TrackerOutput step(double now_s, const PoseInput& pose) override;
  TrackerOutput hold(double now_s) override;
  int attempts() const { return attempts_; }

 private:
  enum class Phase { kApproach, kAlign, kBackUp };
  double pass_time(double now_s);
  void watch_time(double now_s);
  TTwist2D law(const TPose2D& at, double now_s, double dt_s);
  TTwist2D approach(const TPose2D& at, double now_s);
  TTwist2D align(const TPose2D& at, double dt_s);
  TTwist2D back_up(const TPose2D& at);
  double turn_rate(double heading_error) const;

  DockingConfig config_;
  ControlConfig trust_;
  DriveLimits limits_;
  SwitchingPi along_;
  Phase phase_ = Phase::kApproach;
  int attempts_ = 1;
  double speed_m_s_ = 0.0;  ///< the PI's last word
  TurnNudge nudge_;
  double standing_s_ = 0.0;  ///< at the dock, turned to its heading
  TrackerOutput out_;
  bool started_ = false;
  double start_s_ = 0.0, last_s_ = 0.0, next_sample_s_ = 0.0;
  double last_usable_s_ = 0.0;  ///< arrival of the last usable pose, or the start
};

}  // namespace rovigo::control
