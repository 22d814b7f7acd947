// Jump point search against A*, which visits every cell.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planning/jump_point_search.h"

namespace rovigo::planning {
namespace {

using maps::Cell;

/// Noise, blocks or corridors: jump points lie differently in each.
maps::Costmap random_map(std::mt19937_64& random, int kind) {
  maps::GridGeometry g;
  g.resolution_m = 0.1;
  g.width = 1 + static_cast<int>(random() % 200);
  g.height = 1 + static_cast<int>(random() % 90);
  maps::Costmap map(g);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  if (kind == 0) {
    const auto per_mille = 50 + below(350);
    for (auto& cell : map.cells) {
      if (below(1000) < per_mille) cell = maps::Costmap::kLethal;
    }
    return map;
  }
  if (kind == 2) std::fill(map.cells.begin(), map.cells.end(), maps::Costmap::kLethal);
  for (int i = 0; i < 5 + below(40); ++i) {
    const int x0 = below(g.width), y0 = below(g.height);
    const bool flat = below(2) == 0;
    const int w = kind == 1 ? 1 + below(12) : flat ? 20 + below(80) : 1 + below(2);
    const int h = kind == 1 ? 1 + below(12) : flat ? 1 + below(2) : 20 + below(80);
    for (int y = y0; y < std::min(y0 + h, g.height); ++y) {
      for (int x = x0; x < std::min(x0 + w, g.width); ++x) {
        map.at({x, y}) = kind == 1 ? maps::Costmap::kLethal : maps::Costmap::kFree;
      }
    }
  }
  return map;
}

class JumpPoints : public testing::TestWithParam<int> {};

TEST_P(JumpPoints, FindTheLengthsThatAStarFinds) {
  std::mt19937_64 random(77 + static_cast<unsigned>(GetParam()));
  GridSearch astar;
  int found = 0;
  for (int i = 0; i < 120; ++i) {
    const maps::Costmap map = random_map(random, GetParam());
    const SearchGrid grid(map, 8);
    JumpPointSearch jumps(grid);
    for (int query = 0; query < 12; ++query) {
      const auto random_cell = [&] {
        Cell cell;
        for (int t = 0; t < 9 && !map.is_passable(cell); ++t) {
          cell = map.geometry.cell_of(random() % map.geometry.size());
        }
        return cell;
      };
      const Cell start = random_cell(), goal = random_cell();
      const auto want = astar.find(grid, start, goal, {});
      const auto got = jumps.find(start, goal);
      SCOPED_TRACE("map " + std::to_string(i) + " query " + std::to_string(query));
      ASSERT_EQ(got.found, want.found);
      if (!want.found) continue;
      ++found;
      ASSERT_NEAR(got.length_m, want.length_m, 1e-9);
      ASSERT_NEAR(got.cost_m, got.length_m, 1e-7 * got.length_m);
      ASSERT_EQ(got.cells.front(), start);
      ASSERT_EQ(got.cells.back(), goal);
      for (std::size_t k = 1; k < got.cells.size(); ++k) {
        const Cell a = got.cells[k - 1], b = got.cells[k];
        ASSERT_LE(std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)), 1);
        ASSERT_TRUE(map.is_passable(b) && map.is_passable({a.x, b.y}) &&
                    map.is_passable({b.x, a.y}))
            << "cuts a corner at step " << k;
      }
    }
  }
  EXPECT_GT(found, 100);
}

std::string kind_name(const testing::TestParamInfo<int>& info) {
  constexpr const char* kNames[] = {"Noise", "Blocks", "Corridors"};
  return kNames[info.param];
}
INSTANTIATE_TEST_SUITE_P(Maps, JumpPoints, testing::Values(0, 1, 2), kind_name);

TEST(JumpPointSearch, RefusesWhatIsOutsideOrClosed) {
  maps::GridGeometry g;
  g.resolution_m = 1.0;
  g.width = g.height = 3;
  maps::Costmap map(g);
  map.at({1, 1}) = maps::Costmap::kLethal;
  const SearchGrid grid(map, 8);
  JumpPointSearch search(grid);
  EXPECT_FALSE(search.find({0, 0}, {1, 1}).found);
  EXPECT_FALSE(search.find({1, 1}, {0, 0}).found);
  EXPECT_FALSE(search.find({-1, 0}, {0, 0}).found);
  EXPECT_FALSE(search.find({0, 0}, {3, 0}).found);
  EXPECT_EQ(search.find({2, 2}, {2, 2}).cells.size(), 1U);
  EXPECT_NEAR(search.find({0, 0}, {2, 2}).length_m, 4.0, 1e-12);
}

}  // namespace
}  // namespace rovigo::planning
