#pragma once
// The suite's trajectories: curves with clean formulas, timed as the planner times its own.

#include "app/config.h"
#include "app/track/suite.h"
#include "planning/planner.h"
#include "planning/trajectory.h"
#include "sim/world.h"

namespace rovigo::app {

/// A trajectory ready to be driven, in the frame of the world it lies in.
struct PlannedTrack {
  sim::World world;
  planning::Trajectory trajectory;
  TPose2D start;  ///< of the rover, its first heading included
};

/// A floor of 50 x 50 m around the origin: its walls are farther away than any shape is long.
sim::World empty_hall();

/// `config.robot` gives the speed. Throws InputError naming `name` when a goal cannot be planned
/// to.
PlannedTrack plan_track(const std::string& name, const TrackShape& shape,
                        const RovigoConfig& config);

}  // namespace rovigo::app
