#pragma once
// The suite's trajectories: curves with clean formulas, timed as the planner times its own.

#include <memory>

#include "app/config.h"
#include "app/track/suite.h"
#include "maps/map_file.h"
#include "planning/trajectory.h"
#include "sim/world.h"

namespace rovigo::app {

/// A trajectory ready to be driven, in the map's frame; without a map, in the world's.
struct PlannedTrack {
  sim::World world;
  planning::Trajectory trajectory;
  TPose2D start;  ///< of the rover, its first heading included
  TPose2D world_from_map = {};
  std::shared_ptr<const maps::SavedMap> map = {};
};

/// A floor of 50 x 50 m around the origin: its walls are farther away than any shape is long.
sim::World empty_hall();

/// Any shape but goal, mission and recorded. `config.robot` gives the speed.
PlannedTrack plan_shape(const TrackShape& shape, const RovigoConfig& config);

}  // namespace rovigo::app
