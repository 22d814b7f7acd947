// A* against a plain Dijkstra that shares no code with it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <queue>
#include <random>
#include <vector>

#include "planning/any_angle_search.h"
#include "planning/astar.h"
#include "planning/cost_to_go.h"

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

/// Textbook Dijkstra with doubles: the cost of every cell; infinity where there is no way.
std::vector<double> dijkstra(const Costmap& map, Cell start, int connectivity, double weight) {
  std::vector<double> cost(map.cells.size(), std::numeric_limits<double>::infinity());
  if (!map.is_passable(start)) return cost;
  using Item = std::pair<double, std::size_t>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
  cost[map.geometry.index_of(start)] = 0.0;
  open.push({0.0, map.geometry.index_of(start)});
  while (!open.empty()) {
    const auto [c, index] = open.top();
    open.pop();
    if (c > cost[index]) continue;
    const Cell a = map.geometry.cell_of(index);
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
  return cost;
}

double dijkstra(const Costmap& map, Cell start, Cell goal, int connectivity, double weight) {
  return dijkstra(map, start, connectivity, weight)[map.geometry.index_of(goal)];
}

Costmap random_costmap(std::mt19937_64& random, double density, bool soft) {
  maps::GridGeometry g;
  g.resolution_m = 0.05;
  g.width = 5 + static_cast<int>(random() % 60);
  g.height = 5 + static_cast<int>(random() % 60);
  Costmap map(g);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  // On half of the maps most cells cost nothing, as on open ground, where fewer moves are tried.
  const double share = random() % 2 != 0 ? 1.0 : 0.04;
  const double closed = share < 1.0 ? 0.2 * density : density;
  for (auto& cell : map.cells) {
    if (unit(random) < closed) {
      cell = random() % 2 != 0 ? Costmap::kLethal : Costmap::kUnknown;
    } else if (soft && unit(random) < share) {
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

/// Long runs over open ground, on grids of one size in memory and two shapes, by one search: what a
/// query leaves behind would mislead the next.
TEST(AStarOnOpenGround, CostsAreEqualToDijkstrasQueryAfterQuery) {
  std::mt19937_64 random(20240605);
  GridSearch search;
  for (int i = 0; i < 60; ++i) {
    maps::GridGeometry g;
    g.resolution_m = 0.05;
    g.width = i % 2 == 0 ? 94 : 30;
    g.height = i % 2 == 0 ? 30 : 94;
    Costmap map(g);
    for (int k = 0; k < 8; ++k) {
      const int x = static_cast<int>(random() % static_cast<unsigned>(g.width - 6));
      const int y = static_cast<int>(random() % static_cast<unsigned>(g.height - 6));
      for (int c = 0; c < 36; ++c) map.at({x + c % 6, y + c / 6}) = k < 5 ? Costmap::kLethal : 90;
    }
    const auto random_cell = [&] {
      return Cell{static_cast<int>(random() % static_cast<unsigned>(g.width)),
                  static_cast<int>(random() % static_cast<unsigned>(g.height))};
    };
    const Cell start = random_cell(), goal = random_cell();
    const double weight = i % 3 == 0 ? 0.0 : 2.0;
    const double want = dijkstra(map, start, goal, 8, weight);
    const auto got = search.find(SearchGrid(map, 8), start, goal, {.soft_cost = weight});
    ASSERT_EQ(got.found, std::isfinite(want)) << "map " << i;
    if (!got.found) continue;
    ASSERT_NEAR(got.cost_m, want, 1e-4 * want + 1e-12) << "map " << i;
  }
}

TEST_P(AStarAgainstDijkstra, CostToGoIsEqualInEveryCell) {
  const Case param = GetParam();
  std::mt19937_64 random(20240602);
  CostToGo to_go;
  std::size_t reached = 0;
  for (int i = 0; i < 60; ++i) {
    const Costmap map = random_costmap(random, param.density, param.soft_weight > 0.0);
    SCOPED_TRACE("map " + std::to_string(i));
    const SearchGrid grid(map, param.connectivity);
    std::vector<Cell> goals;
    std::vector<double> want(map.cells.size(), std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k <= random() % 3; ++k) {
      goals.push_back(map.geometry.cell_of(random() % map.geometry.size()));
      const auto from_goal = dijkstra(map, goals.back(), param.connectivity, param.soft_weight);
      for (std::size_t c = 0; c < want.size(); ++c) want[c] = std::min(want[c], from_goal[c]);
    }
    to_go.compute(grid, goals, param.soft_weight);
    for (std::size_t c = 0; c < want.size(); ++c) {
      const Cell cell = map.geometry.cell_of(c);
      const double got = to_go.cost_m(cell);
      ASSERT_EQ(std::isfinite(got), std::isfinite(want[c]));
      if (!std::isfinite(got)) continue;
      ++reached;
      ASSERT_NEAR(got, want[c], 1e-4 * want[c] + 1e-12);
      if (random() % 16 != 0) continue;
      const auto way = to_go.way_from(cell);
      ASSERT_EQ(way.cells.front(), cell);
      ASSERT_NE(std::find(goals.begin(), goals.end(), way.cells.back()), goals.end());
      double cost = 0.0;
      for (std::size_t k = 1; k < way.cells.size(); ++k) {
        const Cell a = way.cells[k - 1], b = way.cells[k];
        ASSERT_TRUE(may_step(map, a, b.x - a.x, b.y - a.y));
        cost += step_cost(map, a, b, param.soft_weight);
      }
      ASSERT_NEAR(cost, want[c], 1e-4 * want[c] + 1e-12);
    }
  }
  EXPECT_GT(reached, 2000U) << "the random maps no longer exercise the search";
}

TEST(SearchesOnClosedMoves, GoRoundThemAsDijkstraDoes) {
  // Closing moves by hand breaks what the canonical order of moves rests on.
  std::mt19937_64 random(9);
  GridSearch search;
  CostToGo to_go;
  for (int i = 0; i < 60; ++i) {
    const Costmap map = random_costmap(random, 0.2, false);
    SearchGrid grid(map, 8);
    const auto random_cell = [&] { return map.geometry.cell_of(random() % map.geometry.size()); };
    for (int k = 0; k < 200; ++k) {
      const Cell a = random_cell();
      const auto& m = kMoves[random() % kMoves.size()];
      grid.close_move(a, {a.x + m.dx, a.y + m.dy});
    }
    const Cell goal = random_cell();
    to_go.compute(grid, {goal}, 0.0);
    for (int k = 0; k < 20; ++k) {
      const Cell start = random_cell();
      const auto found = search.find(grid, start, goal, {});
      ASSERT_EQ(found.found, std::isfinite(to_go.cost_m(start)));
      if (!found.found) continue;
      ASSERT_NEAR(found.cost_m, to_go.cost_m(start), 1e-9);
      for (std::size_t c = 1; c < found.cells.size(); ++c) {
        const Cell a = found.cells[c - 1], b = found.cells[c];
        bool open = false;
        for (std::size_t move = 0; move < 8; ++move) {
          open |= (grid.moves()[grid.index_of(a)] >> move & 1U) != 0 &&
                  a.x + kMoves[move].dx == b.x && a.y + kMoves[move].dy == b.y;
        }
        ASSERT_TRUE(open);
      }
    }
  }
}

/// May a straight line between cell centres be driven? Walked in steps far smaller than a cell: no
/// impassable cell is entered or touched at a corner.
bool line_is_free(const Costmap& map, Cell a, Cell b) {
  const int steps = 64 * std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), 1});
  constexpr double kTouch = 1e-9;
  for (int i = 0; i <= steps; ++i) {
    const double x = a.x + 0.5 + (b.x - a.x) * (static_cast<double>(i) / steps);
    const double y = a.y + 0.5 + (b.y - a.y) * (static_cast<double>(i) / steps);
    for (const double dx : {-kTouch, kTouch}) {
      for (const double dy : {-kTouch, kTouch}) {
        if (!map.is_passable(
                Cell{static_cast<int>(std::floor(x + dx)), static_cast<int>(std::floor(y + dy))})) {
          return false;
        }
      }
    }
  }
  return true;
}

TEST(LineOfSight, SeesWhatAFineWalkAlongTheLineSees) {
  std::mt19937_64 random(5);
  int free = 0, blocked = 0;
  for (int i = 0; i < 40; ++i) {
    const Costmap map = random_costmap(random, 0.03, false);
    for (const int connectivity : {4, 8}) {
      const SearchGrid grid(map, connectivity);
      for (int k = 0; k < 100; ++k) {
        const Cell a = map.geometry.cell_of(random() % map.geometry.size());
        // Short lines of simple slopes run through corners.
        const Cell b = k % 2 == 0 ? map.geometry.cell_of(random() % map.geometry.size())
                                  : Cell{a.x + static_cast<int>(random() % 9) - 4,
                                         a.y + static_cast<int>(random() % 9) - 4};
        if (!map.is_passable(a) || !map.is_passable(b)) continue;
        const bool want = line_is_free(map, a, b);
        ++(want ? free : blocked);
        // A walk in steps may miss a corner barely cut by a long line; short ones it sees whole.
        const bool got = line_of_sight(grid, a, b);
        ASSERT_TRUE(want || !got);
        ASSERT_TRUE(got || !want || k % 2 == 0);
        ASSERT_EQ(line_of_sight(grid, a, b), line_of_sight(grid, b, a));
      }
    }
  }
  EXPECT_GT(free, 500);
  EXPECT_GT(blocked, 500);
}

TEST(AnyAngle, IsNeverLongerThanAStarAndEverySegmentIsFree) {
  std::mt19937_64 random(11);
  GridSearch astar;
  AnyAngleSearch any_angle;
  int found = 0, shorter = 0;
  for (int i = 0; i < 200; ++i) {
    const Costmap map = random_costmap(random, 0.02 * static_cast<double>(i % 16), false);
    const SearchGrid grid(map, i % 8 == 0 ? 4 : 8);
    for (int k = 0; k < 5; ++k) {
      const Cell start = map.geometry.cell_of(random() % map.geometry.size());
      const Cell goal = map.geometry.cell_of(random() % map.geometry.size());
      const auto on_grid = astar.find(grid, start, goal, {});
      const auto got = any_angle.find(grid, start, goal);
      SCOPED_TRACE("map " + std::to_string(i) + " query " + std::to_string(k));
      ASSERT_EQ(got.found, on_grid.found);
      if (!got.found) continue;
      ++found;
      ASSERT_LE(got.length_m, on_grid.length_m * (1.0 + 1e-5));
      shorter += got.length_m < 0.999 * on_grid.length_m ? 1 : 0;
      ASSERT_EQ(got.cells.front(), start);
      ASSERT_EQ(got.cells.back(), goal);
      double length = 0.0;
      for (std::size_t c = 1; c < got.cells.size(); ++c) {
        const Cell a = got.cells[c - 1], b = got.cells[c];
        ASSERT_TRUE(line_is_free(map, a, b));
        length += std::hypot(a.x - b.x, a.y - b.y) * map.geometry.resolution_m;
      }
      ASSERT_NEAR(length, got.length_m, 1e-9);
    }
  }
  EXPECT_GT(found, 400);
  EXPECT_GT(shorter, 200) << "straight lines no longer shorten the way";
}

TEST(AnyAngle, HeedsAFurtherTestOfLines) {
  std::mt19937_64 random(12);
  GridSearch astar;
  AnyAngleSearch any_angle;
  for (int i = 0; i < 30; ++i) {
    const Costmap map = random_costmap(random, 0.2, false);
    const SearchGrid grid(map, 8);
    const Cell goal{map.geometry.width - 1, map.geometry.height - 1};
    const auto short_only = [](Cell a, Cell b) { return std::hypot(a.x - b.x, a.y - b.y) < 6.0; };
    const auto got = any_angle.find(grid, {0, 0}, goal, short_only);
    const auto on_grid = astar.find(grid, {0, 0}, goal, {});
    ASSERT_EQ(got.found, on_grid.found);
    if (!got.found) continue;
    ASSERT_LE(got.length_m, on_grid.length_m * (1.0 + 1e-5));
    for (std::size_t c = 1; c < got.cells.size(); ++c) {
      ASSERT_TRUE(short_only(got.cells[c - 1], got.cells[c]));
    }
  }
}

TEST(WeightedAStar, StaysWithinItsBoundAndExpandsLess) {
  std::mt19937_64 random(7);
  GridSearch search;
  std::size_t exact_expanded = 0;
  std::size_t weighted_expanded = 0;
  for (int i = 0; i < 100; ++i) {
    const Costmap map = random_costmap(random, 0.25, i % 2 == 0);
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

TEST(WeightedAStar, OpensNoCellTwiceWhateverTheSoftCosts) {
  maps::GridGeometry g;
  g.resolution_m = 0.05;
  g.width = g.height = 300;
  Costmap map(g);
  std::mt19937_64 random(11);
  for (auto& cell : map.cells) cell = static_cast<std::uint8_t>(random() % Costmap::kMaxSoft);
  const SearchGrid grid(map, 8);
  GridSearch search;
  for (const double weight : {1.01, 1.5, 3.0, 10.0}) {
    const auto found =
        search.find(grid, {0, 0}, {299, 280}, {.soft_cost = 50.0, .heuristic = weight});
    ASSERT_TRUE(found.found);
    EXPECT_LE(found.expanded_cells, g.size()) << "heuristic weight " << weight;
  }
}

}  // namespace
}  // namespace rovigo::planning
