#include "tests/support/grid_checks.h"

#include <algorithm>
#include <cmath>

#include "sim/world_model.h"

namespace rovigo::test {

using maps::Cell;
using maps::OccupancyGrid;

namespace {

constexpr double kGhostClearanceM = 0.15;
constexpr std::size_t kSmallestGhost = 3;
constexpr double kLongestRayM = 100.0;

TPoint2D transformed(const TPose2D& a_from_b, const TPoint2D& p) {
  const TPose2D at = maps::compose(a_from_b, TPose2D(p.x, p.y, 0.0));
  return {at.x, at.y};
}

bool is_free_around(const OccupancyGrid& grid, const TPoint2D& p, double radius_m) {
  const Cell middle = grid.geometry.cell_at(p);
  const int reach = static_cast<int>(std::ceil(radius_m / grid.geometry.resolution_m));
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const Cell c{middle.x + dx, middle.y + dy};
      if (!grid.geometry.contains(c) || !OccupancyGrid::is_free(grid.at(c))) return false;
    }
  }
  return true;
}

/// Takes one cluster of marked cells away and returns its size.
std::size_t take_cluster(std::vector<bool>& marked, const maps::GridGeometry& g, Cell first) {
  std::vector<Cell> open{first};
  marked[g.index_of(first)] = false;
  std::size_t size = 0;
  while (!open.empty()) {
    const Cell c = open.back();
    open.pop_back();
    ++size;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell next{c.x + dx, c.y + dy};
        if (!g.contains(next) || !marked[g.index_of(next)]) continue;
        marked[g.index_of(next)] = false;
        open.push_back(next);
      }
    }
  }
  return size;
}

std::optional<double> distance_to_wall(const OccupancyGrid& grid, const TPoint2D& from,
                                       const TPoint2D& direction) {
  const double step_m = 0.2 * grid.geometry.resolution_m;
  for (double way_m = 0.0; way_m < kLongestRayM; way_m += step_m) {
    const Cell c =
        grid.geometry.cell_at(TPoint2D{from.x + way_m * direction.x, from.y + way_m * direction.y});
    if (!grid.geometry.contains(c)) return std::nullopt;
    if (OccupancyGrid::is_occupied(grid.at(c))) return way_m;
  }
  return std::nullopt;
}

/// `rim_m` or more inside the outline.
bool is_under(const sim::Solid& solid, const TPoint2D& p, double rim_m) {
  const Eigen::Vector3d in_solid =
      solid.world_from_solid.inverse() *
      Eigen::Vector3d(p.x, p.y, solid.world_from_solid.translation().z());
  return std::abs(in_solid.x()) <= 0.5 * solid.size.x() - rim_m &&
         std::abs(in_solid.y()) <= 0.5 * solid.size.y() - rim_m;
}

/// Part of a table that is lower than the rover: by its name, or a top below the obstacle height.
bool is_low_table(const sim::Solid& solid) {
  constexpr double kHighestTopM = 0.5;
  if (solid.name.find("low_table") != std::string::npos) return true;
  const double top_m = solid.world_from_solid.translation().z() + 0.5 * solid.size.z();
  return solid.name.ends_with("::top") && top_m < kHighestTopM;
}

bool is_under_low_table(const sim::World& world, const TPoint2D& p, double rim_m) {
  const auto& solids = world.model().solids;
  return std::any_of(solids.begin(), solids.end(),
                     [&](const sim::Solid& s) { return is_low_table(s) && is_under(s, p, rim_m); });
}

}  // namespace

int ghost_cells(const OccupancyGrid& estimate, const OccupancyGrid& truth,
                const TPose2D& truth_from_estimate) {
  const auto& g = estimate.geometry;
  std::vector<bool> amid_free(g.size(), false);
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (!OccupancyGrid::is_occupied(estimate.cells[i])) continue;
    const TPoint2D p = transformed(truth_from_estimate, g.center_of(g.cell_of(i)));
    amid_free[i] = is_free_around(truth, p, kGhostClearanceM);
  }
  std::size_t ghosts = 0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (!amid_free[i]) continue;
    const std::size_t size = take_cluster(amid_free, g, g.cell_of(i));
    if (size >= kSmallestGhost) ghosts += size;
  }
  return static_cast<int>(ghosts);
}

std::optional<double> wall_to_wall_m(const OccupancyGrid& grid, const TPose2D& grid_from_truth,
                                     const TPoint2D& middle, double spread_m) {
  constexpr int kRaysEachSide = 4;
  const double cosine = std::cos(grid_from_truth.phi), sine = std::sin(grid_from_truth.phi);
  std::vector<double> lengths;
  for (int i = -kRaysEachSide; i <= kRaysEachSide; ++i) {
    const TPoint2D from =
        transformed(grid_from_truth, {middle.x, middle.y + spread_m * i / double{kRaysEachSide}});
    const auto ahead = distance_to_wall(grid, from, {cosine, sine});
    const auto behind = distance_to_wall(grid, from, {-cosine, -sine});
    if (!ahead || !behind) return std::nullopt;
    lengths.push_back(*ahead + *behind);
  }
  std::sort(lengths.begin(), lengths.end());
  return lengths[lengths.size() / 2];
}

std::optional<double> low_table_share(const OccupancyGrid& estimate, const OccupancyGrid& truth,
                                      const TPose2D& truth_from_estimate, const sim::World& world) {
  const TPose2D estimate_from_truth = maps::inverse(truth_from_estimate);
  const auto& g = truth.geometry;
  std::vector<TPoint2D> table;
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (!OccupancyGrid::is_occupied(truth.cells[i])) continue;
    const TPoint2D p = g.center_of(g.cell_of(i));
    if (is_under_low_table(world, p, 0.0)) table.push_back(p);
  }
  if (table.empty()) return std::nullopt;
  const auto held = [&](const TPoint2D& shift) {
    return std::count_if(table.begin(), table.end(), [&](const TPoint2D& p) {
      const Cell c = estimate.geometry.cell_at(transformed(estimate_from_truth, p + shift));
      return estimate.geometry.contains(c) && OccupancyGrid::is_occupied(estimate.at(c));
    });
  };
  std::ptrdiff_t most = 0;
  for (const double dx : {-1.0, 0.0, 1.0}) {
    for (const double dy : {-1.0, 0.0, 1.0}) {
      most = std::max(most, held({dx * g.resolution_m, dy * g.resolution_m}));
    }
  }
  return static_cast<double>(most) / static_cast<double>(table.size());
}

int low_table_free_cells(const OccupancyGrid& estimate, const TPose2D& truth_from_estimate,
                         const sim::World& world) {
  const auto& g = estimate.geometry;
  int cells = 0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (!OccupancyGrid::is_free(estimate.cells[i])) continue;
    const TPoint2D p = transformed(truth_from_estimate, g.center_of(g.cell_of(i)));
    cells += is_under_low_table(world, p, 1.5 * g.resolution_m) ? 1 : 0;
  }
  return cells;
}

}  // namespace rovigo::test
