#pragma once
// The maps people plan on, and long queries on them.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "maps/movingai.h"
#include "maps/ros_map.h"
#include "planning/cost_to_go.h"

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

/// A grid repeated side by side until it has `side` x `side` cells.
inline maps::OccupancyGrid tiled(const maps::OccupancyGrid& grid, int side) {
  maps::OccupancyGrid out;
  out.geometry = grid.geometry;
  out.geometry.width = out.geometry.height = side;
  out.cells.resize(out.geometry.size());
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      out.cells[out.geometry.index_of({x, y})] =
          grid.at({x % grid.geometry.width, y % grid.geometry.height});
    }
  }
  return out;
}

inline std::vector<maps::Cell> passable_cells(const planning::SearchGrid& grid) {
  std::vector<maps::Cell> out;
  for (std::size_t i = 0; i < grid.geometry().size(); ++i) {
    const maps::Cell cell = grid.geometry().cell_of(i);
    if (grid.is_passable(cell)) out.push_back(cell);
  }
  return out;
}

using CellPair = std::pair<maps::Cell, maps::Cell>;

/// From random starts to random goals at least 0.6 times as far along the grid as the farthest cell
/// that can be reached, by a fixed seed; four goals to a start.
inline std::vector<CellPair> long_queries(const planning::SearchGrid& grid, std::size_t count) {
  std::mt19937_64 random(2024);
  const std::vector<maps::Cell> passable = passable_cells(grid);
  std::vector<CellPair> out;
  planning::CostToGo way;
  while (out.size() < count && !passable.empty()) {
    const maps::Cell start = passable[random() % passable.size()];
    way.compute(grid, {start}, 0.0);
    double farthest = 0.0;
    std::size_t reached = 0;
    for (const maps::Cell cell : passable) {
      const double length = way.cost_m(cell);
      if (!std::isfinite(length)) continue;
      ++reached;
      farthest = std::max(farthest, length);
    }
    if (reached < passable.size() / 4) continue;  // a pocket
    for (int k = 0; k < 4 && out.size() < count;) {
      const maps::Cell goal = passable[random() % passable.size()];
      const double length = way.cost_m(goal);
      if (!std::isfinite(length) || length < 0.6 * farthest) continue;
      out.emplace_back(start, goal);
      ++k;
    }
  }
  return out;
}

}  // namespace rovigo::benchmarks
