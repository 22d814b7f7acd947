#pragma once
// Drives between places, planned as `rovigo drive` plans its own: to goals that a suite names, and
// missions whose places are drawn.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "app/track/shapes.h"

namespace rovigo::app {

/// The ground a suite's goals and missions lie on, opened once: a map file with the world it was
/// recorded in, or a world with its true grid as the map.
std::shared_ptr<const maps::SavedMap> open_track_map(const TrackShape& shape,
                                                     const std::filesystem::path& folder,
                                                     const RovigoConfig& config);

/// To the shape's goal, from where the map's recording began. Throws InputError naming the
/// trajectory `name` when there is no way.
PlannedTrack plan_goal(const std::string& name, const TrackShape& shape,
                       std::shared_ptr<const maps::SavedMap> map, const RovigoConfig& config);

/// Start and goal drawn by `seed` among the places where the rover may stand, until a drive between
/// them is accepted; half of the goals ask for a heading. `world` "random": drawn, too; `map` is
/// then empty. Throws InputError when no drive of a metre or more is found.
PlannedTrack draw_mission(const std::string& name, const TrackShape& shape,
                          std::shared_ptr<const maps::SavedMap> map, const RovigoConfig& config,
                          std::uint64_t seed);

}  // namespace rovigo::app
