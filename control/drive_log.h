#pragma once
// What happened during one drive, step by step: the raw material of metrics and reports.

#include <string>
#include <vector>

#include "control/drive_controller.h"
#include "control/drive_guard.h"

namespace rovigo::control {

/// One control step. Poses and twists are those at `time_s`; the command was given at `time_s`.
struct DriveStep {
  double time_s = 0.0;     ///< since the drive began
  TPose2D true_pose;       ///< map_from_base; on a real rover, the best reference there is
  TPose2D estimated_pose;  ///< what the tracker was told
  PoseQuality quality = PoseQuality::kLost;
  double sigma_position_m = 0.0;      ///< 1-sigma, as the estimator states it
  TTwist2D command;                   ///< to the motors, as the drive side lets it pass; m/s, rad/s
  StopCause held = StopCause::kNone;  ///< why the drive side holds the rover
  TTwist2D true_twist;                ///< of base_link, in base_link
  planning::TrajectoryPoint reference;
  double heading_error_rad = 0.0;    ///< as the tracker saw it
  double cross_track_error_m = 0.0;  ///< as the tracker saw it; left of the path positive
};

struct DriveLog {
  std::vector<DriveStep> steps;
  int contact_events = 0;
  std::string touched;  ///< what was touched first; empty: nothing
  TrackStatus status = TrackStatus::kRunning;
  StopCause held = StopCause::kNone;  ///< at the end
  bool start_known = true;            ///< false: not recognised, not even by looking around
  int looked_around = 0;              ///< times it looked for a pose lost on the way
};

}  // namespace rovigo::control
