#pragma once
// The maps people plan on, and long queries on them.

#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "maps/movingai.h"
#include "maps/ros_map.h"
#include "planning/search_grid.h"

namespace rovigo::benchmarks {

inline constexpr const char* kWillow = "ros/willow-full-0.05.yaml";
inline constexpr const char* kBlocks = "ros/100by100_15.yaml";
inline constexpr const char* kParis = "movingai/Paris_1_1024.map";

/// The grid of a data file; empty where the data is not here.
inline maps::OccupancyGrid load_map(const std::string& file) {
  const char* named = std::getenv("ROVIGO_TEST_DATA");
  const std::filesystem::path data =
      named ? named : std::filesystem::path(ROVIGO_SOURCE_DIR) / ".." / "shared" / "data";
  const auto path = data / "maps" / file;
  if (!std::filesystem::exists(path)) return {};
  std::vector<std::string> warnings;
  return path.extension() == ".map" ? maps::load_movingai_map(path)
                                    : maps::load_ros_map(path, warnings);
}

using CellPair = std::pair<maps::Cell, maps::Cell>;

/// Steps along the grid to every cell that can be reached from `start`, in the order of a flood.
struct Flood {
  Flood(const planning::SearchGrid& grid, maps::Cell start) : steps(grid.padded_size(), -1) {
    const auto offsets = grid.offsets();
    queue.push_back(grid.index_of(start));
    steps[queue.front()] = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (std::size_t move = 0; move < 8; ++move) {
        if ((grid.moves()[queue[i]] >> move & 1U) == 0) continue;
        const auto next = static_cast<std::uint32_t>(static_cast<int>(queue[i]) + offsets[move]);
        if (steps[next] >= 0) continue;
        steps[next] = steps[queue[i]] + 1;
        queue.push_back(next);
      }
    }
  }
  std::vector<int> steps;
  std::vector<std::uint32_t> queue;
};

/// From random starts to goals at least 0.6 times as many steps away as the farthest reachable
/// cell, by a fixed seed.
inline std::vector<CellPair> long_queries(const planning::SearchGrid& grid, std::size_t count) {
  std::mt19937_64 random(2024);
  const auto& g = grid.geometry();
  std::vector<maps::Cell> passable;
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (grid.is_passable(g.cell_of(i))) passable.push_back(g.cell_of(i));
  }
  std::vector<CellPair> out;
  while (out.size() < count && !passable.empty()) {
    const maps::Cell start = passable[random() % passable.size()];
    const Flood flood(grid, start);
    const int farthest = flood.steps[flood.queue.back()];
    if (flood.queue.size() < passable.size() / 4) continue;  // a pocket
    for (int k = 0; k < 4 && out.size() < count;) {
      const std::uint32_t goal = flood.queue[random() % flood.queue.size()];
      if (flood.steps[goal] < 0.6 * farthest) continue;
      out.emplace_back(start, grid.cell_of(goal));
      ++k;
    }
  }
  return out;
}

}  // namespace rovigo::benchmarks
