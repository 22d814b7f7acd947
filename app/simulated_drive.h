#pragma once
// The closed loop: simulator, pose source, tracker. `record` and `drive` both run on it.

#include <mrpt/obs/CObservation.h>

#include <functional>
#include <string>

#include "app/pose_source.h"
#include "control/drive_log.h"
#include "control/tracker.h"
#include "sim/simulator.h"

namespace rovigo::app {

struct DriveHooks {
  std::function<void(double share)> progress;  ///< of the planned duration
  std::function<void(const mrpt::obs::CObservation&)> observation;
};

/// Stands still for a second (the gyro's bias can be learned), drives until the tracker ends the
/// drive, stands still for half a second. Control runs at 120 Hz of simulated time.
control::DriveLog drive_in_simulator(sim::Simulator& simulator, const TPose2D& world_from_map,
                                     PoseSource& poses, control::TrajectoryTracker& tracker,
                                     double planned_duration_s, const DriveHooks& hooks);

/// SHA-256, hex, over the steps (index, true pose, estimate, command) as little-endian doubles.
std::string log_hash(const control::DriveLog& log);

}  // namespace rovigo::app
