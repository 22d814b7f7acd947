#pragma once
// The thesis's controller as a drive from start to finish, so that it can be measured next to ours.

#include "control/drive_controller.h"
#include "control/reference_controller.h"

namespace rovigo::control {

/// Steers by every pose as it comes, as the thesis does: no filter, no prediction. Called faster
/// than 100 Hz it still takes 100 steps a second, and repeats its command in between. Ends when the
/// law has no waypoint left, or when the time is up.
class ReferenceDrive final : public DriveController {
 public:
  static constexpr int kSegments = 100;  ///< that the path is cut into (mission R9)

  /// Precondition: the trajectory is not empty.
  ReferenceDrive(const ReferenceConfig& config, const planning::Trajectory& trajectory,
                 double time_limit_s);

  TrackerOutput step(double now_s, const PoseInput& pose) override;
  TrackerOutput hold(double now_s) override;

 private:
  ReferenceDrive(const ReferenceConfig& config, std::vector<planning::TrajectoryPoint> waypoints,
                 double time_limit_s);

  void pass_time(double now_s);

  std::vector<planning::TrajectoryPoint> waypoints_;
  ReferenceController law_;
  double time_limit_s_;
  bool started_ = false;
  double start_s_ = 0.0;
  double last_s_ = 0.0;
  double next_step_s_ = 0.0;
  TrackerOutput last_;
};

/// `segments` + 1 points of the trajectory, the same way along it apart; turns in place have none
/// of their own.
std::vector<planning::TrajectoryPoint> evenly_spaced(const planning::Trajectory& trajectory,
                                                     int segments);

}  // namespace rovigo::control
