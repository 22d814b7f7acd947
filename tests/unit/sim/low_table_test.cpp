// Tables that are too low to drive under: what the truth says of them.

#include <gtest/gtest.h>

#include "test_worlds.h"

namespace rovigo::sim {
namespace {

/// Tops of low tables: thin boards whose upper face is between 0.35 and 0.45 m.
std::vector<Solid> low_tops(const World& world) {
  std::vector<Solid> tops;
  for (const auto& solid : world.model().solids) {
    const double top = solid.world_from_solid.translation().z() + solid.size.z() / 2;
    const bool board = solid.kind == Solid::Kind::kBox && solid.size.z() < 0.05;
    const bool named = solid.name.size() > 5 && solid.name.substr(solid.name.size() - 5) == "::top";
    if (board && named && top > 0.3499 && top < 0.4501) tops.push_back(solid);
  }
  return tops;
}

TEST(LowTable, StandsInTheLabAndInEveryRandomOffice) {
  EXPECT_GE(low_tops(World::load(ROVIGO_SOURCE_DIR "/sim/worlds/lab.sdf")).size(), 1U);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_GE(low_tops(World::random_office(seed)).size(), 1U) << "random:" << seed;
  }
}

TEST(LowTable, IsAnObstacleAtItsWholeTop) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const World world = World::random_office(seed);
    const auto grid = true_grid(world, 0.05, 0.05, 0.50);
    for (const auto& top : low_tops(world)) {
      for (double u = -0.49; u < 0.5; u += 0.07) {
        for (double v = -0.49; v < 0.5; v += 0.07) {
          const Eigen::Vector3d p =
              top.world_from_solid * Eigen::Vector3d(u * top.size.x(), v * top.size.y(), 0.0);
          EXPECT_TRUE(
              maps::OccupancyGrid::is_occupied(grid.at(grid.geometry.cell_at({p.x(), p.y()}))));
        }
      }
    }
  }
}

TEST(LowTable, OnlyWhatTheCameraSawOfItIsJudged) {
  WorldModel model = bare_floor();
  model.solids.push_back(box_at(1.8, 0.0, 0.36, {0.6, 0.9, 0.04}));  // nobody sees its legs
  const World world(model);
  SimulatorOptions options = blind_options();
  const Simulator simulator(world, options);
  SeenSurfaces seen(world, 0.05, 0.05, 0.50);
  seen.add_view(simulator.truth().world_from_base + simulator.rig().base_from_camera,
                simulator.rig().camera);
  const auto grid = seen.grid();
  EXPECT_TRUE(maps::OccupancyGrid::is_occupied(grid.at(grid.geometry.cell_at({1.52, 0.01}))))
      << "its edge";
  EXPECT_TRUE(maps::OccupancyGrid::is_unknown(grid.at(grid.geometry.cell_at({1.98, 0.01}))))
      << "its underside is seen at too grazing an angle";
}

}  // namespace
}  // namespace rovigo::sim
