#pragma once
// A new way for a rover that is under way: obstacles appear, goals move.

#include <optional>

#include "planning/free_space.h"
#include "planning/smoother.h"
#include "planning/timing.h"

namespace rovigo::planning {

struct SpliceProblem {
  const Trajectory& running;  ///< not empty
  double time_s = 0.0;        ///< when the new way is taken
  /// Free, at least two points; the first is replaced by where the rover is at that time.
  Path way;
  std::optional<double> goal_heading_rad;  ///< turns in place at the end
};

enum class SpliceStatus {
  kOk,
  kNoRoom,   ///< no free curve joins the way with the rover's position, heading and curvature
  kTooFast,  ///< the curve that joins cannot be driven at the rover's speed
};

struct SpliceResult {
  SpliceStatus status = SpliceStatus::kNoRoom;
  /// From time_s on, its first point at time 0: the running pose, speed and turn rate, then along
  /// the new way, timed anew. Position, heading, speed and turn rate are continuous, accelerations
  /// bounded. Empty unless kOk: then the rover must stop on the running trajectory first.
  Trajectory trajectory;
};

SpliceResult splice(const FreeSpace& space, const SpliceProblem& problem,
                    const SplineConfig& spline, const MotionLimits& limits,
                    const TimingConfig& timing);

/// The running trajectory until `time_s`, then `next`.
Trajectory joined(const Trajectory& running, double time_s, const Trajectory& next);

}  // namespace rovigo::planning
