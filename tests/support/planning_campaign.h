#pragma once
// Random queries through the whole planner on one map, judged by what shares no code with it: a
// flood over the same lethal cells, and the checker of trajectories.

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "maps/inflation.h"
#include "maps/occupancy_grid.h"
#include "planning/planner_config.h"

namespace rovigo::test {

struct CampaignOptions {
  std::size_t queries = 1000;
  std::uint64_t seed = 1;
  unsigned threads = 1;  ///< the report is the same for any number
  planning::PlannerConfig planner = {};
  maps::InflationConfig inflation = {};  ///< what the planner keeps; checked is the rover's radius
};

/// Counts; all but the first group must be 0.
struct CampaignReport {
  std::size_t queries = 0;
  std::size_t planned = 0;
  std::size_t escapes = 0;  ///< of those planned, from a start inside the band
  std::map<std::string, std::size_t> refused;
  std::size_t samples = 0;  ///< points of trajectories looked at, at most 2 mm apart
  double length_m = 0.0;

  std::size_t unsafe_samples = 0;
  std::size_t bad_trajectories = 0;  ///< break a limit, jump, or end elsewhere than asked
  std::size_t bad_refusals = 0;      ///< without code, words or place
  std::size_t wrong_verdicts = 0;    ///< planned or refused otherwise than the flood says
  std::size_t exceptions = 0;
  std::vector<std::string> troubles;  ///< of the above, in words

  std::size_t failures() const {
    return unsafe_samples + bad_trajectories + bad_refusals + wrong_verdicts + exceptions;
  }
  void add(const CampaignReport& other);
};

/// Three quarters of the queries join points in passable cells, a part of them over via points; the
/// others join points anywhere, also inside obstacles and off the map.
CampaignReport run_campaign(const maps::OccupancyGrid& grid, const CampaignOptions& options);

/// The true grid of a random office.
maps::OccupancyGrid random_world_grid(std::uint64_t seed);
/// A grid with unknown and occupied specks, as maps made from recordings have them.
maps::OccupancyGrid speckled(maps::OccupancyGrid grid, std::uint64_t seed);

/// Every map of the data folder and the grids of `random_worlds` offices, half of them speckled; by
/// name. Maps that are not here are left out.
std::vector<std::pair<std::string, maps::OccupancyGrid>> campaign_maps(std::size_t random_worlds);

}  // namespace rovigo::test
