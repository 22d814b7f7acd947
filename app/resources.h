#pragma once
// Worlds, routes, scenarios and suites by name or by path; outputs checked before the work begins.

#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/route.h"
#include "sim/scenario.h"
#include "sim/world.h"

namespace rovigo::app {

/// A name in sim/worlds, "random:SEED", or a path to an SDF file. Throws InputError naming the
/// worlds there are.
sim::World open_world(const std::string& name_or_path);
/// A name in sim/routes, or a path to a YAML file.
sim::Route open_route(const std::string& name_or_path);
/// A name in sim/scenarios, or a path to a YAML file.
sim::Scenario open_scenario(const std::string& name_or_path);

/// The file of a name in sim/suites, or of a path.
std::filesystem::path find_suite(const std::string& name_or_path);

/// Throws InputError when a file could not be written here: long work must not end in "no such
/// folder". A folder that does not exist yet counts as unwritable.
void require_writable(const std::filesystem::path& file);

}  // namespace rovigo::app
