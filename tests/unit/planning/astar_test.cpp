#include "planning/astar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace rovigo::planning {
namespace {

using maps::Cell;
using maps::Costmap;

/// Rows from top to bottom; '#' lethal, '?' unknown, 'a'..'y' growing soft cost, else free.
Costmap costmap_of(const std::vector<std::string>& rows, double resolution_m = 1.0) {
  maps::GridGeometry g;
  g.resolution_m = resolution_m;
  g.width = static_cast<int>(rows.front().size());
  g.height = static_cast<int>(rows.size());
  Costmap map(g);
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      const char c = rows[static_cast<std::size_t>(g.height - 1 - y)][static_cast<std::size_t>(x)];
      auto& out = map.at({x, y});
      if (c == '#') out = Costmap::kLethal;
      if (c == '?') out = Costmap::kUnknown;
      if (c >= 'a' && c <= 'y') out = static_cast<std::uint8_t>(10 * (c - 'a' + 1));
    }
  }
  return map;
}

double length(const Costmap& map, Cell start, Cell goal, int connectivity = 8) {
  GridSearch search;
  const auto result = search.find(SearchGrid(map, connectivity), start, goal, {});
  return result.found ? result.length_m : -1.0;
}

TEST(AStar, StraightWayHasTheLengthOfTheStraightWay) {
  const auto map = costmap_of({".....", ".....", "....."}, 0.5);
  EXPECT_DOUBLE_EQ(length(map, {0, 1}, {4, 1}), 2.0);
  EXPECT_DOUBLE_EQ(length(map, {0, 0}, {4, 2}), 0.5 * (2.0 + 2.0 * std::sqrt(2.0)));
  EXPECT_DOUBLE_EQ(length(map, {0, 0}, {4, 2}, 4), 3.0);
}

TEST(AStar, StartEqualToGoalIsAPathOfOneCell) {
  GridSearch search;
  const auto result = search.find(SearchGrid(costmap_of({"..", ".."}), 8), {1, 1}, {1, 1}, {});
  ASSERT_TRUE(result.found);
  EXPECT_EQ(result.cells, (std::vector<Cell>{{1, 1}}));
  EXPECT_EQ(result.length_m, 0.0);
}

TEST(AStar, NeverSqueezesThroughADiagonalGap) {
  const auto map = costmap_of({"..#.",  //
                               "..#.",  //
                               "##..",  //
                               "...."});
  EXPECT_EQ(length(map, {0, 3}, {3, 0}), -1.0);
}

TEST(AStar, NeverCutsACorner) {
  const auto map = costmap_of({"...",  //
                               ".#.",  //
                               "..."});
  EXPECT_DOUBLE_EQ(length(map, {0, 1}, {1, 0}), 2.0);
  EXPECT_DOUBLE_EQ(length(map, {0, 1}, {2, 1}), 4.0);
}

TEST(AStar, TheMapsEdgeIsAWall) {
  const auto map = costmap_of({".#.",  //
                               ".#."});
  EXPECT_EQ(length(map, {0, 0}, {2, 0}), -1.0);
  EXPECT_EQ(length(map, {0, 0}, {3, 0}), -1.0);
  EXPECT_EQ(length(map, {-1, 0}, {0, 0}), -1.0);
}

TEST(AStar, UnknownCellsAreNotEntered) {
  EXPECT_EQ(length(costmap_of({".?."}), {0, 0}, {2, 0}), -1.0);
}

TEST(AStar, SoftCostsAreWorthADetourOnlyWhenTheyOutweighIt) {
  const auto map = costmap_of({"...........",  //
                               "...........",  //
                               "...yyyyy...",  //
                               "...yyyyy...",  //
                               "...yyyyy..."});
  const SearchGrid grid(map, 8);
  GridSearch search;
  const auto straight = search.find(grid, {0, 0}, {10, 0}, {.soft_cost = 0.0});
  const auto detour = search.find(grid, {0, 0}, {10, 0}, {.soft_cost = 5.0});
  EXPECT_DOUBLE_EQ(straight.length_m, 10.0);
  EXPECT_GT(detour.length_m, 10.5);
  for (const Cell c : detour.cells) EXPECT_EQ(map.at(c), Costmap::kFree);
}

TEST(AStar, SameQuerySamePathInAUsedWorkspace) {
  const auto map = costmap_of({"..........", "....##....", "....##....", ".........."});
  const SearchGrid grid(map, 8);
  GridSearch fresh;
  GridSearch used;
  for (int i = 0; i < 5; ++i) used.find(grid, {9, i % 4}, {0, 0}, {});
  used.nearest_reachable(grid, {0, 0}, {3.0, 3.0});
  EXPECT_EQ(fresh.find(grid, {0, 1}, {9, 2}, {}).cells, used.find(grid, {0, 1}, {9, 2}, {}).cells);
}

TEST(AStar, HugeSoftCostsDoNotOverflow) {
  maps::GridGeometry g;
  g.width = 20000;
  g.height = 3;
  Costmap map(g, Costmap::kMaxSoft);
  GridSearch search;
  const auto result =
      search.find(SearchGrid(map, 8), {0, 1}, {19999, 1}, {.soft_cost = 50.0, .heuristic = 1.0});
  ASSERT_TRUE(result.found);
  EXPECT_EQ(result.cells.size(), 20000U);
  EXPECT_NEAR(result.cost_m, 51.0 * result.length_m, 1e-3 * result.cost_m);
}

TEST(AStar, NearestReachableCellIsOnTheStartsSideOfTheWall) {
  const auto map = costmap_of({"...#...", "...#...", "...#..."});
  GridSearch search;
  const auto cell = search.nearest_reachable(SearchGrid(map, 8), {0, 0}, {5.5, 1.5});
  ASSERT_TRUE(cell.has_value());
  EXPECT_EQ(*cell, (Cell{2, 1}));
  EXPECT_FALSE(search.nearest_reachable(SearchGrid(map, 8), {3, 0}, {5.5, 1.5}).has_value());
}

TEST(AStar, AClosedMoveIsNotTaken) {
  SearchGrid grid(costmap_of({"...", "#.#", "..."}), 8);
  GridSearch search;
  EXPECT_TRUE(search.find(grid, {1, 0}, {1, 2}, {}).found);
  grid.close_move({1, 1}, {1, 2});
  EXPECT_FALSE(search.find(grid, {1, 0}, {1, 2}, {}).found);
}

}  // namespace
}  // namespace rovigo::planning
