#pragma once
// What a controller is told and what it answers, whichever law it follows.

#include "maps/geometry.h"
#include "planning/trajectory.h"

namespace rovigo::control {

/// How far the pose may be trusted; decides the speed (design.md, "Safety in motion").
enum class PoseQuality { kGood, kDoubtful, kLost };

/// The estimator's word on where the rover is.
struct PoseInput {
  double time_s = 0.0;  ///< when the pose held, on the caller's clock
  TPose2D map_from_base;
  double sigma_position_m = 0.0;
  PoseQuality quality = PoseQuality::kLost;
};

enum class TrackStatus {
  kRunning,
  kReached,     ///< at the goal, at rest
  kPoseLost,    ///< no usable pose for longer than patience allows
  kNoProgress,  ///< stagnated
  kTimedOut,    ///< far behind the trajectory's own duration
  kStopped,     ///< the drive side held the rover for good (drive_guard.h says why)
};

const char* to_string(TrackStatus status);

struct TrackerOutput {
  TTwist2D command;  ///< vx m/s, omega rad/s; zero when stopped
  TrackStatus status = TrackStatus::kRunning;
  planning::TrajectoryPoint reference;  ///< what it steers to now
  double heading_error_rad = 0.0;
  double cross_track_error_m = 0.0;  ///< signed, left of the path positive, of the estimated pose
};

/// Drives one trajectory. Time comes in from outside; implementations read no clock.
class DriveController {
 public:
  virtual ~DriveController() = default;
  /// The command at `now_s`, given the newest pose (which may be old, doubtful or lost).
  virtual TrackerOutput step(double now_s, const PoseInput& pose) = 0;
  /// In place of step() while the drive side holds the rover: nothing that is commanded happens.
  /// The time does not count, and the next step() goes on from standstill.
  virtual TrackerOutput hold(double now_s) = 0;
};

}  // namespace rovigo::control
