// The judge is judged: what the figures of low tables say of grids made by hand.

#include "tests/support/grid_checks.h"

#include <gtest/gtest.h>

#include "sim/simulator.h"
#include "sim/world_model.h"

namespace rovigo::test {
namespace {

constexpr double kCellM = 0.05;

/// A room with a table; its name tells nothing.
sim::World world_with_table(double top_m) {
  sim::WorldModel model;
  model.name = "room";
  const auto box = [&](const std::string& name, const Eigen::Vector3d& size, double x, double y,
                       double z) {
    sim::Solid s;
    s.name = name;
    s.size = size;
    s.world_from_solid.translation() << x, y, z;
    model.solids.push_back(s);
  };
  box("wall::link::wall", {0.1, 4.0, 2.0}, -0.5, 0.0, 1.0);
  box("wall::link::wall", {0.1, 4.0, 2.0}, 4.0, 0.0, 1.0);
  box("thing_3::link::top", {0.58, 0.88, 0.04}, 2.0, 0.0, top_m - 0.02);
  return sim::World(std::move(model));
}

class LowTable : public ::testing::Test {
 protected:
  sim::World world_ = world_with_table(0.40);
  maps::OccupancyGrid truth_ = sim::true_grid(world_, kCellM, 0.05, 0.50);
};

TEST_F(LowTable, AMapOffByACellHoldsTheTableButOneOffByThreeDoesNot) {
  EXPECT_EQ(low_table_share(truth_, truth_, {0, 0, 0}, world_), 1.0);
  EXPECT_EQ(low_table_share(truth_, truth_, {kCellM, -kCellM, 0}, world_), 1.0);
  EXPECT_LT(*low_table_share(truth_, truth_, {3 * kCellM, 0, 0}, world_), 0.95);
}

TEST_F(LowTable, ATableKnownByItsRimAloneIsNotHeld) {
  maps::OccupancyGrid rim = truth_;
  for (double x = 1.78; x < 2.23; x += kCellM) {
    for (double y = -0.37; y < 0.38; y += kCellM) {
      rim.at(rim.geometry.cell_at({x, y})) = maps::OccupancyGrid::kFree;
    }
  }
  EXPECT_LT(*low_table_share(rim, truth_, {0, 0, 0}, world_), 0.5);
  EXPECT_GT(low_table_free_cells(rim, {0, 0, 0}, world_), 50);
  EXPECT_EQ(low_table_free_cells(truth_, {0, 0, 0}, world_), 0);
}

TEST_F(LowTable, ADeskThatIsDrivenUnderIsNotAskedFor) {
  const sim::World desk = world_with_table(0.75);
  EXPECT_FALSE(low_table_share(truth_, truth_, {0, 0, 0}, desk).has_value());
  EXPECT_EQ(low_table_free_cells(truth_, {0, 0, 0}, desk), 0);
}

}  // namespace
}  // namespace rovigo::test
