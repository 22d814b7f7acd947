#pragma once
// What a scenario file changes: sensor noise, faults, disturbances. Defaults: design.md's figures.

#include <filesystem>
#include <string>

namespace rovigo::sim {

struct Scenario {
  std::string name = "default";
};

/// Throws InputError naming file, line, key, value and limit.
Scenario load_scenario(const std::filesystem::path& file);

}  // namespace rovigo::sim
