// A* against a plain Dijkstra that shares no code with it.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <queue>
#include <random>
#include <vector>

#include "planning/astar.h"

namespace rovigo::planning {
namespace {

using maps::Cell;
using maps::Costmap;

double price(const Costmap& map, Cell c, double weight) {
  return 1.0 + weight * map.at(c) / Costmap::kMaxSoft;
}

/// May the rover step from a by (dx, dy)? Both cells beside a diagonal must be passable.
bool may_step(const Costmap& map, Cell a, int dx, int dy) {
  return map.is_passable({a.x + dx, a.y + dy}) && map.is_passable({a.x + dx, a.y}) &&
         map.is_passable({a.x, a.y + dy});
}

double step_cost(const Costmap& map, Cell a, Cell b, double weight) {
  return std::hypot(a.x - b.x, a.y - b.y) * 0.5 * (price(map, a, weight) + price(map, b, weight)) *
         map.geometry.resolution_m;
}

/// Textbook Dijkstra with doubles; infinity where there is no way.
double dijkstra(const Costmap& map, Cell start, Cell goal, int connectivity, double weight) {
  if (!map.is_passable(start) || !map.is_passable(goal)) {
    return std::numeric_limits<double>::infinity();
  }
  std::vector<double> cost(map.cells.size(), std::numeric_limits<double>::infinity());
  using Item = std::pair<double, std::size_t>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
  cost[map.geometry.index_of(start)] = 0.0;
  open.push({0.0, map.geometry.index_of(start)});
  while (!open.empty()) {
    const auto [c, index] = open.top();
    open.pop();
    if (c > cost[index]) continue;
    const Cell a = map.geometry.cell_of(index);
    if (a == goal) return c;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if ((dx == 0 && dy == 0) || (connectivity == 4 && dx != 0 && dy != 0)) continue;
        if (!may_step(map, a, dx, dy)) continue;
        const Cell b{a.x + dx, a.y + dy};
        const double next = c + step_cost(map, a, b, weight);
        if (next < cost[map.geometry.index_of(b)]) {
          cost[map.geometry.index_of(b)] = next;
          open.push({next, map.geometry.index_of(b)});
        }
      }
    }
  }
  return std::numeric_limits<double>::infinity();
}

Costmap random_costmap(std::mt19937_64& random, double density, bool soft) {
  maps::GridGeometry g;
  g.resolution_m = 0.05;
  g.width = 5 + static_cast<int>(random() % 60);
  g.height = 5 + static_cast<int>(random() % 60);
  Costmap map(g);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (auto& cell : map.cells) {
    if (unit(random) < density) {
      cell = random() % 2 != 0 ? Costmap::kLethal : Costmap::kUnknown;
    } else if (soft) {
      cell = static_cast<std::uint8_t>(random() % (Costmap::kMaxSoft + 1));
    }
  }
  return map;
}

struct Case {
  int connectivity;
  double soft_weight;
  double density;
};

class AStarAgainstDijkstra : public testing::TestWithParam<Case> {};

TEST_P(AStarAgainstDijkstra, CostsAreEqualAndPathsLegal) {
  const Case param = GetParam();
  constexpr std::uint64_t kSeed = 20240601;
  RecordProperty("seed", std::to_string(kSeed));
  std::mt19937_64 random(kSeed);
  GridSearch search;
  int found = 0;
  for (int i = 0; i < 150; ++i) {
    const Costmap map = random_costmap(random, param.density, param.soft_weight > 0.0);
    const SearchGrid grid(map, param.connectivity);
    const auto random_cell = [&] {
      return Cell{static_cast<int>(random() % static_cast<unsigned>(map.geometry.width)),
                  static_cast<int>(random() % static_cast<unsigned>(map.geometry.height))};
    };
    const Cell start = random_cell();
    const Cell goal = random_cell();
    const double want = dijkstra(map, start, goal, param.connectivity, param.soft_weight);
    const auto got = search.find(grid, start, goal, {.soft_cost = param.soft_weight});
    SCOPED_TRACE("map " + std::to_string(i));
    ASSERT_EQ(got.found, std::isfinite(want));
    if (!got.found) continue;
    ++found;
    // 1e-4 relative: prices are rounded to a fraction of a step.
    ASSERT_NEAR(got.cost_m, want, 1e-4 * want + 1e-12);
    ASSERT_EQ(got.cells.front(), start);
    ASSERT_EQ(got.cells.back(), goal);
    double cost = 0.0;
    for (std::size_t k = 1; k < got.cells.size(); ++k) {
      const Cell a = got.cells[k - 1];
      const Cell b = got.cells[k];
      ASSERT_LE(std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)), 1);
      ASSERT_TRUE(may_step(map, a, b.x - a.x, b.y - a.y));
      if (param.connectivity == 4) {
        ASSERT_EQ(std::abs(a.x - b.x) + std::abs(a.y - b.y), 1);
      }
      cost += step_cost(map, a, b, param.soft_weight);
    }
    ASSERT_NEAR(cost, want, 1e-4 * want + 1e-12);
  }
  EXPECT_GT(found, 20) << "the random maps no longer exercise the search";
}

INSTANTIATE_TEST_SUITE_P(RandomGrids, AStarAgainstDijkstra,
                         testing::Values(Case{8, 0.0, 0.2}, Case{8, 0.0, 0.35}, Case{4, 0.0, 0.2},
                                         Case{4, 0.0, 0.3}, Case{8, 3.0, 0.15}, Case{8, 20.0, 0.3},
                                         Case{4, 3.0, 0.2}));

TEST(WeightedAStar, StaysWithinItsBoundAndExpandsLess) {
  std::mt19937_64 random(7);
  GridSearch search;
  std::size_t exact_expanded = 0;
  std::size_t weighted_expanded = 0;
  for (int i = 0; i < 100; ++i) {
    const Costmap map = random_costmap(random, 0.25, true);
    const SearchGrid grid(map, 8);
    const Cell goal{map.geometry.width - 1, map.geometry.height - 1};
    const auto exact = search.find(grid, {0, 0}, goal, {.soft_cost = 1.0});
    const auto fast = search.find(grid, {0, 0}, goal, {.soft_cost = 1.0, .heuristic = 2.0});
    ASSERT_EQ(exact.found, fast.found);
    if (!exact.found) continue;
    EXPECT_LE(exact.cost_m, fast.cost_m * (1.0 + 1e-9));
    EXPECT_LE(fast.cost_m, 2.0 * exact.cost_m * (1.0 + 1e-9));
    exact_expanded += exact.expanded_cells;
    weighted_expanded += fast.expanded_cells;
  }
  EXPECT_LT(weighted_expanded, exact_expanded);
}

}  // namespace
}  // namespace rovigo::planning
