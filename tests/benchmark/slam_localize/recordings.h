#pragma once
// Recordings to localise in, with the truth beside them (TUM trajectory, world frame).

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/config.h"
#include "maps/map_file.h"
#include "sim/route.h"
#include "sim/scenario.h"
#include "sim/world.h"

namespace rovigo::slam_localize {

struct MappedWorld;

inline constexpr double kCameraRateHz = 15.0;
inline constexpr double kTurnRateRadS = 0.5;

/// Beside a recording: where the rover truly was at every observation.
std::filesystem::path truth_of(const std::filesystem::path& recording);

/// Whether recording and truth are whole; one that a stopped run left half is made again.
bool is_made(const std::filesystem::path& recording);

/// Drives a route on true poses.
void record_drive(const sim::World& world, const std::string& world_name, const sim::Route& route,
                  const sim::Scenario& scenario, std::uint64_t seed,
                  const app::RovigoConfig& config, const std::filesystem::path& recording);

/// As `rovigo map` does.
maps::SavedMap map_recording(const std::filesystem::path& recording,
                             const app::RovigoConfig& config);

/// Puts the rover down at `world_from_base` and turns it in place for `duration_s`.
void record_turn(const sim::World& world, const std::string& world_name,
                 const TPose2D& world_from_base, double turn_rate_rad_s, double duration_s,
                 const sim::Scenario& scenario, std::uint64_t seed, const app::RovigoConfig& config,
                 const std::filesystem::path& recording);

/// A free place within `reach_m`, in sight, of a random pose of the mapping tour; any heading.
TPose2D random_start(const MappedWorld& world, const app::RovigoConfig& config, double reach_m,
                     std::uint64_t seed);

/// A kidnap from `from`, with the rover then at `from` turned by `turned_rad`: a free, mapped place
/// 4 m away in the same room or another, 120 deg turned. Nothing where there is no such place.
std::optional<sim::Kidnap> random_kidnap(const MappedWorld& world, const app::RovigoConfig& config,
                                         const TPose2D& from, double time_s, std::uint64_t seed);

}  // namespace rovigo::slam_localize
