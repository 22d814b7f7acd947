// Raises walls from a grid's occupied cells.

#include <algorithm>
#include <string>

#include "maps/error.h"
#include "sim/world.h"
#include "sim/world_model.h"

namespace rovigo::sim {
namespace {

using maps::Cell;
using maps::OccupancyGrid;

constexpr double kFloorMarginM = 5.0;

/// A rectangle of cells, both corners included.
struct Block {
  Cell first;
  Cell last;
};

/// Covers the occupied cells with few rectangles: each grows as far right as it can, then as far
/// up as whole rows allow.
std::vector<Block> cover_with_blocks(const OccupancyGrid& grid) {
  const auto& g = grid.geometry;
  std::vector<bool> open(grid.cells.size());
  for (std::size_t i = 0; i < open.size(); ++i) {
    open[i] = OccupancyGrid::is_occupied(grid.cells[i]);
  }
  const auto row_is_open = [&](int y, int x0, int x1) {
    for (int x = x0; x <= x1; ++x) {
      if (!open[g.index_of({x, y})]) return false;
    }
    return true;
  };
  std::vector<Block> blocks;
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      if (!open[g.index_of({x, y})]) continue;
      Block b{{x, y}, {x, y}};
      while (b.last.x + 1 < g.width && open[g.index_of({b.last.x + 1, y})]) ++b.last.x;
      while (b.last.y + 1 < g.height && row_is_open(b.last.y + 1, x, b.last.x)) ++b.last.y;
      for (int v = y; v <= b.last.y; ++v) {
        for (int u = x; u <= b.last.x; ++u) open[g.index_of({u, v})] = false;
      }
      blocks.push_back(b);
    }
  }
  return blocks;
}

/// The free cell with the most room around it (by rows and columns), so that a rover put down
/// there by default is clear of walls.
TPose2D roomiest_place(const OccupancyGrid& grid) {
  const auto& g = grid.geometry;
  std::vector<int> room(grid.cells.size(), 0);
  const auto reach = [&](int x, int y) {
    return x < 0 || y < 0 || x >= g.width || y >= g.height ? 0 : room[g.index_of({x, y})];
  };
  // Chessboard distance to the nearest cell that is not free, in two passes.
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      if (!OccupancyGrid::is_free(grid.at({x, y}))) continue;
      room[g.index_of({x, y})] = 1 + std::min({reach(x - 1, y), reach(x, y - 1),
                                               reach(x - 1, y - 1), reach(x + 1, y - 1)});
    }
  }
  Cell best{g.width / 2, g.height / 2};
  int most = 0;
  for (int y = g.height - 1; y >= 0; --y) {
    for (int x = g.width - 1; x >= 0; --x) {
      int& here = room[g.index_of({x, y})];
      here = std::min(here, 1 + std::min({reach(x + 1, y), reach(x, y + 1), reach(x + 1, y + 1),
                                          reach(x - 1, y + 1)}));
      if (here > most) {
        most = here;
        best = {x, y};
      }
    }
  }
  const TPoint2D p = g.center_of(best);
  return {p.x, p.y, 0.0};
}

}  // namespace

World World::from_grid(const OccupancyGrid& grid, double wall_height_m) {
  const auto& g = grid.geometry;
  if (g.width <= 0 || g.height <= 0 || grid.cells.size() != g.size()) {
    throw maps::InputError("cannot raise walls from an empty grid");
  }
  if (!(wall_height_m > 0.0 && wall_height_m <= 100.0)) {
    throw maps::InputError("wall height " + std::to_string(wall_height_m) +
                           " m is outside (0, 100]");
  }
  WorldModel model;
  model.name = "grid";
  const double width_m = g.width * g.resolution_m;
  const double height_m = g.height * g.resolution_m;
  Solid floor;
  floor.kind = Solid::Kind::kPlane;
  floor.name = "floor";
  floor.size = {width_m + 2 * kFloorMarginM, height_m + 2 * kFloorMarginM, 1.0};
  floor.world_from_solid.translation() << g.origin.x + width_m / 2, g.origin.y + height_m / 2, 0.0;
  floor.material = {{0.62F, 0.60F, 0.56F}, Pattern::kTiles, name_seed("floor")};
  model.solids.push_back(floor);
  constexpr Pattern kCoverings[] = {Pattern::kNoise, Pattern::kBricks, Pattern::kWood};
  for (const auto& b : cover_with_blocks(grid)) {
    const TPoint2D low = g.center_of(b.first);
    const TPoint2D high = g.center_of(b.last);
    Solid wall;
    wall.name = "wall_" + std::to_string(model.solids.size());
    wall.size = {high.x - low.x + g.resolution_m, high.y - low.y + g.resolution_m, wall_height_m};
    wall.world_from_solid.translation() << (low.x + high.x) / 2, (low.y + high.y) / 2,
        wall_height_m / 2;
    const std::uint32_t seed = name_seed(wall.name);
    wall.material = {{0.75F, 0.72F, 0.66F}, kCoverings[seed % 3], seed};
    model.solids.push_back(wall);
  }
  model.start = roomiest_place(grid);
  return World(std::move(model));
}

}  // namespace rovigo::sim
