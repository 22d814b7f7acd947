#pragma once
// A drive recorded earlier as a trajectory to follow: its path, timed anew.

#include <filesystem>
#include <memory>
#include <string>

#include "app/track/shapes.h"

namespace rovigo::app {

/// `map`: where the rover was while it was recorded, in the map's world; null: the shape's TUM file
/// (base_link, relative to `folder`), moved to begin at the origin in an empty hall. Throws
/// InputError naming the trajectory `name` for a drive shorter than 0.2 m.
PlannedTrack plan_recorded(const std::string& name, const TrackShape& shape,
                           const std::filesystem::path& folder,
                           std::shared_ptr<const maps::SavedMap> map, const RovigoConfig& config);

}  // namespace rovigo::app
