#include "slam/overhang.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace rovigo::slam {
namespace {

/// One cell's bands, the lowest first: '#' occupied, '.' free, ' ' unknown.
CellBands bands_of(const std::string& text) {
  CellBands out;
  for (std::size_t b = 0; b < text.size(); ++b) {
    if (text[b] == '#') out.occupied |= static_cast<std::uint16_t>(1U << b);
    if (text[b] == '.') out.free |= static_cast<std::uint16_t>(1U << b);
  }
  return out;
}

constexpr int kSide = 40;

/// A room of free cells to draw in, and what is made of it.
class Tops : public ::testing::Test {
 protected:
  Tops() : grid_(geometry()), bands_(grid_.cells.size(), bands_of(".........")) {
    for (auto& c : grid_.cells) c = maps::OccupancyGrid::kFree;
  }
  void draw(int x0, int x1, int y0, int y1, const std::string& bands) {
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) bands_[grid_.geometry.index_of({x, y})] = bands_of(bands);
    }
  }
  int filled(int x0, int x1, int y0, int y1) {
    maps::OccupancyGrid grid = grid_;
    fill_overhangs(bands_, grid);
    int cells = 0;
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) cells += maps::OccupancyGrid::is_occupied(grid.at({x, y}));
    }
    return cells;
  }
  static maps::GridGeometry geometry() {
    maps::GridGeometry g;
    g.resolution_m = 0.05;
    g.width = g.height = kSide;
    return g;
  }

  maps::OccupancyGrid grid_;
  std::vector<CellBands> bands_;
};

TEST_F(Tops, ATopIsWholeBetweenItsEdges) {
  draw(10, 20, 10, 20, "......#..");
  draw(11, 19, 11, 19, "...... ..");
  EXPECT_EQ(filled(0, kSide - 1, 0, kSide - 1), 81) << "the edges are occupied without it";
}

TEST_F(Tops, ATopIsWholeBetweenTheTwoSidesThatWereSeenAsFarAsTheseEncloseIt) {
  draw(10, 20, 10, 20, "...... ..");
  draw(10, 20, 10, 10, "......#..");
  draw(10, 10, 10, 20, "......#..");
  EXPECT_EQ(filled(11, 14, 11, 14), 16) << "between the sides";
  EXPECT_EQ(filled(18, 20, 18, 20), 0) << "how far it reaches nobody has seen";
}

/// The chair of random:53: a seat seen from two sides, its shadow up to a wall behind. The wall's
/// outermost cells let single rays through, and so do legs.
TEST_F(Tops, TheShadowBetweenASeatAndAWallIsNoTop) {
  draw(5, 20, 5, 20, "........ ");
  draw(12, 20, 12, 20, ".......  ");
  draw(12, 20, 12, 12, ".......##");
  draw(20, 20, 12, 20, ".......##");
  draw(13, 13, 19, 19, "...# ..# ");  // a leg
  draw(3, 4, 0, 25, "###...## ");
  draw(0, 25, 21, 22, "#..#.. # ");
  EXPECT_EQ(filled(5, 11, 5, 20), 0);
  EXPECT_EQ(filled(16, 19, 13, 16), 16) << "the seat itself";
}

/// The table of the corridor's east room: its side and a wall's fringe, which looks like an edge.
TEST_F(Tops, AWallsFringeIsNoEdge) {
  draw(10, 25, 10, 20, "...... ..");
  draw(10, 10, 10, 20, "......#..");
  draw(10, 25, 10, 10, "......#..");
  draw(10, 25, 20, 20, "......##.");
  draw(10, 25, 21, 22, "#########");
  draw(25, 25, 10, 20, "......#..");
  draw(26, 27, 10, 22, "#########");
  EXPECT_EQ(filled(20, 24, 15, 19), 0) << "nobody saw the table's far corner";
  EXPECT_EQ(filled(11, 13, 11, 13), 9);
}

TEST_F(Tops, ATopStaysWholeBesideItsLegs) {
  draw(10, 20, 10, 20, "......#..");
  draw(11, 19, 11, 19, "...... ..");
  for (const int x : {10, 20}) {
    for (const int y : {10, 20}) draw(x, x, y, y, "#######..");
  }
  EXPECT_EQ(filled(11, 19, 11, 19), 81);
}

TEST_F(Tops, EdgesOfOtherHeightsEncloseNoTop) {
  draw(10, 20, 10, 20, "....#....");
  draw(11, 19, 11, 19, "...... ..");
  EXPECT_EQ(filled(11, 19, 11, 19), 0);
}

}  // namespace
}  // namespace rovigo::slam
