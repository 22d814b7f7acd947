// Worlds: SDF files read and refused, random offices, walls raised from grids, true grids.

#include "sim/world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <deque>
#include <filesystem>
#include <fstream>

#include "maps/error.h"
#include "sim/random.h"
#include "test_worlds.h"

namespace rovigo::sim {
namespace {

namespace fs = std::filesystem;

/// A file that is gone when the test ends.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(fs::temp_directory_path() /
              ("rovigo_world_" + std::to_string(::getpid()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name() + ".sdf")) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { fs::remove(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string sdf_with(const std::string& content) {
  return "<?xml version='1.0'?><sdf version='1.9'><world name='w'>" + content + "</world></sdf>";
}

std::string model_with(const std::string& geometry, const std::string& more = "",
                       const std::string& is_static = "true") {
  return "<model name='m'><static>" + is_static + "</static><pose>1 2 0 0 0 1.5707963</pose>" +
         "<link name='l'><pose>0.5 0 0 0 0 0</pose><visual name='v'><pose>0 0 0.4 0 0 0</pose>" +
         "<geometry>" + geometry + "</geometry>" + more + "</visual></link></model>";
}

std::string refusal_of(const std::string& sdf) {
  const TemporaryFile file(sdf);
  try {
    World::load(file.path());
  } catch (const maps::InputError& e) {
    const std::string message = e.what();
    EXPECT_EQ(message.rfind(file.path().string(), 0), 0U) << "names the file: " << message;
    return message;
  }
  return "accepted";
}

TEST(SdfWorld, ComposesThePosesOfModelLinkAndVisual) {
  const TemporaryFile file(
      sdf_with("<frame name='rover_start'><pose>3 4 0 0 0 0.5</pose></frame>" +
               model_with("<box><size>0.2 0.4 0.8</size></box>",
                          "<material><diffuse>0.5 0.25 1 1</diffuse><script><uri>x</uri>"
                          "<name>Rovigo/Bricks</name></script></material>")));
  const World world = World::load(file.path());
  EXPECT_EQ(world.name(), "w");
  EXPECT_DOUBLE_EQ(world.start().x, 3.0);
  EXPECT_NEAR(world.start().phi, 0.5, 1e-12);
  ASSERT_EQ(world.model().solids.size(), 1U);
  const Solid& box = world.model().solids.front();
  // The link's 0.5 m ahead lies along +y after the model's quarter turn.
  EXPECT_TRUE(box.world_from_solid.translation().isApprox(Eigen::Vector3d(1.0, 2.5, 0.4), 1e-6));
  EXPECT_NEAR((box.world_from_solid.linear() * Eigen::Vector3d::UnitX()).y(), 1.0, 1e-6);
  EXPECT_EQ(box.material.pattern, Pattern::kBricks);
  EXPECT_FLOAT_EQ(box.material.color[2], 1.0F);
}

TEST(SdfWorld, WithoutAStartFrameTheRoverStartsAtTheOrigin) {
  const TemporaryFile file(sdf_with(model_with("<box><size>1 1 1</size></box>")));
  const TPose2D start = World::load(file.path()).start();
  EXPECT_EQ(start.x, 0.0);
  EXPECT_EQ(start.y, 0.0);
  EXPECT_EQ(start.phi, 0.0);
}

TEST(SdfWorld, CollisionsOfALinkReplaceItsVisualsForThePhysics) {
  const TemporaryFile file(sdf_with(
      "<model name='m'><static>true</static><link name='l'><visual name='v'><geometry><box><size>"
      "1 1 1</size></box></geometry></visual><collision name='c'><geometry><cylinder><radius>0.3"
      "</radius><length>2</length></cylinder></geometry></collision></link></model>"));
  const World world = World::load(file.path());
  ASSERT_EQ(world.model().solids.size(), 2U);
  EXPECT_TRUE(world.model().solids[0].visible);
  EXPECT_FALSE(world.model().solids[0].touchable);
  EXPECT_FALSE(world.model().solids[1].visible);
  EXPECT_TRUE(world.model().solids[1].touchable);
}

TEST(SdfWorld, RefusesWhatItCannotUseAndNamesTheElement) {
  const std::string box = "<box><size>1 1 1</size></box>";
  EXPECT_THAT(refusal_of(sdf_with(model_with("<sphere><radius>1</radius></sphere>"))),
              testing::HasSubstr("'m::l::v': unsupported <geometry>"));
  EXPECT_THAT(refusal_of(sdf_with(model_with("<box><size>1 -1 1</size></box>"))),
              testing::HasSubstr("m::l::v"));
  EXPECT_THAT(refusal_of(sdf_with(model_with(box, "", "false"))),
              testing::HasSubstr("model 'm' is not <static>"));
  EXPECT_THAT(refusal_of(sdf_with(
                  model_with(box,
                             "<material><script><uri>x</uri><name>Rovigo/Marble</name></script>"
                             "</material>"))),
              testing::HasSubstr("unknown material script 'Rovigo/Marble'; known: Rovigo/Plain"));
  EXPECT_THAT(refusal_of(sdf_with("")), testing::HasSubstr("no surfaces"));
  EXPECT_THAT(refusal_of("<sdf version='1.9'></sdf>"), testing::HasSubstr("<world>"));
  EXPECT_THAT(refusal_of("not xml at all"), testing::HasSubstr("not a usable SDF file"));
  EXPECT_THAT(refusal_of(""), testing::HasSubstr("not a usable SDF file"));
  EXPECT_THAT(refusal_of(sdf_with(model_with(box)).substr(0, 150)),
              testing::HasSubstr("not a usable SDF file"));
  EXPECT_THROW(World::load("/nowhere/lab.sdf"), maps::InputError);
  EXPECT_THROW(World::load("/"), maps::InputError);
}

TEST(TrueGrid, MarksWhatCutsTheHeightBandAndNothingElse) {
  WorldModel model = bare_floor();
  const auto add = [&](double x, double bottom, double height) {
    model.solids.push_back(box_at(x, 0.0, bottom, {0.2, 0.2, height}));
  };
  add(1.0, 0.0, 1.0);    // a pillar
  add(2.0, 0.72, 0.03);  // a desk top: above the band
  add(3.0, 0.40, 0.05);  // a seat: inside it
  add(4.0, 0.0, 0.02);   // a door sill: below it
  add(5.0, 2.0, 0.6);    // a lintel
  const auto grid = true_grid(World(model), 0.05, 0.05, 0.50);
  const auto at = [&](double x, double y) { return grid.at(grid.geometry.cell_at({x, y})); };
  EXPECT_EQ(at(1.0, 0.0), maps::OccupancyGrid::kOccupied);
  EXPECT_EQ(at(2.0, 0.0), maps::OccupancyGrid::kFree);
  EXPECT_EQ(at(3.0, 0.0), maps::OccupancyGrid::kOccupied);
  EXPECT_EQ(at(4.0, 0.0), maps::OccupancyGrid::kFree);
  EXPECT_EQ(at(5.0, 0.0), maps::OccupancyGrid::kFree);
  EXPECT_EQ(at(1.5, 0.0), maps::OccupancyGrid::kFree);
  int occupied = 0;
  for (const auto v : grid.cells) occupied += maps::OccupancyGrid::is_occupied(v) ? 1 : 0;
  EXPECT_EQ(occupied, 2 * 4 * 4) << "boxes on cell borders fill their cells and no others";
}

TEST(TrueGrid, ARotatedBoxCoversExactlyTheCellsItTouches) {
  WorldModel model = bare_floor();
  Solid box = box_at(0.0, 0.0, 0.0, {1.0, 0.4, 1.0});
  box.world_from_solid.linear() =
      Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  model.solids.push_back(box);
  model.start = {0.0, 2.0, 0.0};
  const auto grid = true_grid(World(model), 0.05, 0.05, 0.50);
  for (int y = 0; y < grid.geometry.height; ++y) {
    for (int x = 0; x < grid.geometry.width; ++x) {
      // Brute force: does any of 21 x 21 points of the cell lie in the box?
      bool touched = false;
      const auto c = grid.geometry.center_of({x, y});
      for (int i = -10; i <= 10; ++i) {
        for (int j = -10; j <= 10; ++j) {
          const Eigen::Vector3d p = box.world_from_solid.inverse() *
                                    Eigen::Vector3d(c.x + 0.00249 * i, c.y + 0.00249 * j, 0.5);
          touched = touched || (std::abs(p.x()) < 0.5 && std::abs(p.y()) < 0.2);
        }
      }
      if (touched) {
        EXPECT_EQ(grid.at({x, y}), maps::OccupancyGrid::kOccupied) << x << ", " << y;
      } else if (grid.at({x, y}) == maps::OccupancyGrid::kOccupied) {
        // A corner may graze a cell between two sample points, by less than their spacing.
        const Eigen::Vector3d p = box.world_from_solid.inverse() * Eigen::Vector3d(c.x, c.y, 0.5);
        EXPECT_LT(
            std::hypot(std::max(0.0, std::abs(p.x()) - 0.5), std::max(0.0, std::abs(p.y()) - 0.2)),
            0.05 * std::sqrt(0.5) + 1e-6);
      }
    }
  }
}

TEST(TrueGrid, OutsideTheWallsIsUnknown) {
  const World world = World::load(ROVIGO_SOURCE_DIR "/sim/worlds/corridor.sdf");
  const auto grid = true_grid(world, 0.05, 0.05, 0.50);
  const auto at = [&](double x, double y) { return grid.at(grid.geometry.cell_at({x, y})); };
  EXPECT_EQ(at(15.0, 2.5), maps::OccupancyGrid::kFree);
  EXPECT_EQ(at(15.0, 4.5), maps::OccupancyGrid::kUnknown);
  EXPECT_EQ(at(15.0, 1.64), maps::OccupancyGrid::kOccupied);
}

TEST(SeenSurfaces, KeepOnlyTheFacesACameraLookedAt) {
  WorldModel model = bare_floor();
  model.solids.push_back(box_at(2.0, 0.0, 0.0, {0.5, 1.0, 1.0}));
  const World world(model);
  Simulator simulator(world, blind_options());
  SeenSurfaces seen(world, 0.05, 0.05, 0.50);
  const auto count = [](const maps::OccupancyGrid& grid) {
    int n = 0;
    for (const auto v : grid.cells) n += maps::OccupancyGrid::is_occupied(v) ? 1 : 0;
    return n;
  };
  EXPECT_EQ(count(seen.grid()), 0);
  const auto& rig = simulator.rig();
  seen.add_view(simulator.truth().world_from_base + rig.base_from_camera, rig.camera);
  EXPECT_EQ(count(seen.grid()), 20) << "the near face: 1 m in cells of 5 cm";
  const auto grid = seen.grid();
  EXPECT_EQ(grid.at(grid.geometry.cell_at({1.76, 0.01})), maps::OccupancyGrid::kOccupied);
  EXPECT_EQ(grid.at(grid.geometry.cell_at({2.24, 0.01})), maps::OccupancyGrid::kUnknown);
}

TEST(SeenSurfaces, LeaveOutWhatIsTooGrazingForAReturn) {
  WorldModel model = bare_floor();
  model.solids.push_back(box_at(2.5, -0.35, 0.0, {5.0, 0.1, 1.0}));  // a wall along the view
  const World world(model);
  Simulator simulator(world, blind_options());
  SeenSurfaces seen(world, 0.05, 0.05, 0.50);
  const auto& rig = simulator.rig();
  seen.add_view(simulator.truth().world_from_base + rig.base_from_camera, rig.camera);
  const auto grid = seen.grid();
  // The wall's face is 0.3 m beside the camera: 80 degrees of incidence are reached 1.7 m ahead.
  EXPECT_EQ(grid.at(grid.geometry.cell_at({1.2, -0.32})), maps::OccupancyGrid::kOccupied);
  EXPECT_EQ(grid.at(grid.geometry.cell_at({2.5, -0.32})), maps::OccupancyGrid::kUnknown);
}

/// Cells the rover's centre can reach from the start: those farther than `radius` from obstacles.
std::vector<bool> reachable(const maps::OccupancyGrid& grid, const TPoint2D& start, double radius) {
  const auto& g = grid.geometry;
  const int reach = static_cast<int>(std::ceil(radius / g.resolution_m));
  std::vector<bool> blocked(g.size(), false);
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (!maps::OccupancyGrid::is_occupied(grid.cells[i])) continue;
    const maps::Cell c = g.cell_of(i);
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const maps::Cell n{c.x + dx, c.y + dy};
        if (g.contains(n) && std::hypot(dx, dy) * g.resolution_m <= radius + g.resolution_m / 2) {
          blocked[g.index_of(n)] = true;
        }
      }
    }
  }
  std::vector<bool> reached(g.size(), false);
  const maps::Cell seed = g.cell_at(start);
  if (!g.contains(seed) || blocked[g.index_of(seed)]) return reached;
  std::deque<maps::Cell> open{seed};
  reached[g.index_of(seed)] = true;
  while (!open.empty()) {
    const maps::Cell c = open.front();
    open.pop_front();
    for (const maps::Cell n : {maps::Cell{c.x + 1, c.y}, maps::Cell{c.x - 1, c.y},
                               maps::Cell{c.x, c.y + 1}, maps::Cell{c.x, c.y - 1}}) {
      if (!g.contains(n) || blocked[g.index_of(n)] || reached[g.index_of(n)]) continue;
      reached[g.index_of(n)] = true;
      open.push_back(n);
    }
  }
  return reached;
}

TEST(RandomOffice, EveryRoomCanBeReachedAndTheStartIsFree) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const World world = World::random_office(seed);
    const auto grid = true_grid(world, 0.05, 0.05, 0.50);
    const auto& g = grid.geometry;
    const auto reached = reachable(grid, maps::position_of(world.start()), 0.35);
    // No pocket as large as a room may be cut off: of the free floor nearly all must be reached
    // once what is too close to an obstacle is left out.
    const auto anywhere = [&](const maps::Cell& c, double radius) {
      const int r = static_cast<int>(radius / g.resolution_m);
      for (int y = -r; y <= r; ++y) {
        for (int x = -r; x <= r; ++x) {
          const maps::Cell n{c.x + x, c.y + y};
          if (!g.contains(n) || !maps::OccupancyGrid::is_free(grid.at(n))) return false;
        }
      }
      return true;
    };
    int roomy = 0;
    int missed = 0;
    for (std::size_t i = 0; i < g.size(); ++i) {
      if (!anywhere(g.cell_of(i), 0.45)) continue;
      ++roomy;
      missed += reached[i] ? 0 : 1;
    }
    EXPECT_GT(roomy, 2000) << "seed " << seed;
    EXPECT_EQ(missed, 0) << "seed " << seed;
    EXPECT_NO_THROW(Simulator(world, [&] {
      SimulatorOptions options = blind_options();
      options.world_from_base = world.start();
      return options;
    }()));
  }
}

TEST(RandomOffice, OneSeedIsOneWorld) {
  const auto solids = [](std::uint64_t seed) { return World::random_office(seed).model().solids; };
  const auto a = solids(5);
  const auto b = solids(5);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name, b[i].name);
    EXPECT_TRUE(a[i].world_from_solid.matrix() == b[i].world_from_solid.matrix());
    EXPECT_TRUE(a[i].size == b[i].size);
  }
  EXPECT_NE(a.size(), solids(6).size());
}

TEST(GridWorld, RaisesWallsExactlyOnTheOccupiedCells) {
  maps::GridGeometry g;
  g.resolution_m = 0.05;
  g.origin = {-1.0, 2.0};
  g.width = 60;
  g.height = 40;
  maps::OccupancyGrid grid(g, maps::OccupancyGrid::kFree);
  RandomStream random(3);
  for (auto& v : grid.cells) {
    if (random.uniform(0.0, 1.0) < 0.2) v = maps::OccupancyGrid::kOccupied;
  }
  for (int x = 0; x < g.width; ++x) {  // closed, so that the flood stays inside
    grid.at({x, 0}) = grid.at({x, g.height - 1}) = maps::OccupancyGrid::kOccupied;
  }
  const World world = World::from_grid(grid, 1.0);
  const auto again = true_grid(world, 0.05, 0.05, 0.50);
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      const bool wall = maps::OccupancyGrid::is_occupied(grid.at({x, y}));
      const auto seen = again.at(again.geometry.cell_at(g.center_of({x, y})));
      EXPECT_EQ(maps::OccupancyGrid::is_occupied(seen), wall) << x << ", " << y;
    }
  }
}

TEST(GridWorld, MergesWallsIntoFewBoxes) {
  maps::GridGeometry g;
  g.width = 200;
  g.height = 200;
  maps::OccupancyGrid grid(g, maps::OccupancyGrid::kFree);
  for (int i = 0; i < 200; ++i) {
    for (const int w : {0, 1, 198, 199}) {
      grid.at({i, w}) = grid.at({w, i}) = maps::OccupancyGrid::kOccupied;
    }
  }
  const World world = World::from_grid(grid, 1.0);
  EXPECT_LE(world.model().solids.size(), 5U) << "four walls and the floor";
  EXPECT_NEAR(world.start().x, 5.0, 0.3) << "put down in the middle";
}

TEST(GridWorld, RefusesEmptyGridsAndSillyHeights) {
  EXPECT_THROW(World::from_grid(maps::OccupancyGrid{}, 1.0), maps::InputError);
  maps::GridGeometry g;
  g.width = g.height = 3;
  EXPECT_THROW(World::from_grid(maps::OccupancyGrid(g), std::nan("")), maps::InputError);
}

}  // namespace
}  // namespace rovigo::sim
