#pragma once
// Follows a timed trajectory with feed-forward and two PI loops, heading and speed.

#include <memory>

#include "control/control_config.h"
#include "control/drive_controller.h"
#include "maps/robot_model.h"
#include "planning/trajectory.h"

namespace rovigo::control {

/// One drive along one trajectory. Time comes in from outside; nothing here reads a clock.
class TrajectoryTracker final : public DriveController {
 public:
  TrajectoryTracker(const ControlConfig& config, const maps::RobotModel& robot,
                    planning::Trajectory trajectory);
  ~TrajectoryTracker() override;

  /// The command at `now_s`, given the newest pose (which may be old, doubtful or lost).
  TrackerOutput step(double now_s, const PoseInput& pose) override;
  TrackerOutput hold(double now_s) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rovigo::control
