#include "mapped_world.h"

#include <mrpt/math/TPose3D.h>

#include "app/resources.h"
#include "app/route_maker.h"
#include "recordings.h"
#include "sim/simulator.h"

namespace rovigo::slam_localize {

namespace {

constexpr std::uint64_t kTourSeed = 1;

}  // namespace

sim::Route mapping_route(const std::string& name, const sim::World& world,
                         const app::RovigoConfig& config) {
  return app::route_in_world(name == "lab" ? "lab_tour" : "turns:40:1", world, config);
}

MappedWorld open_mapped_world(const std::string& name, const std::filesystem::path& folder,
                              const app::RovigoConfig& config, bool remap) {
  std::filesystem::create_directories(folder);
  const sim::World world = app::open_world(name);
  MappedWorld out{name, folder, world, {}, {}, {}};
  out.true_grid =
      sim::true_grid(world, config.slam.grid.grid_resolution_m, 0.02, config.robot.body_height_m);
  const auto map_file = folder / "map.rovigo";
  if (remap || !std::filesystem::exists(map_file)) {
    const auto tour = folder / "tour.rawlog";
    if (!is_made(tour)) {
      const sim::Route route = mapping_route(name, world, config);
      record_drive(world, name, route, sim::Scenario{}, kTourSeed, config, tour);
    }
    maps::save_map(map_recording(tour, config), map_file);
  }
  out.map = maps::load_map(map_file);
  for (const maps::StoredPose& p : out.map.trajectory) {
    out.driven.push_back(maps::compose(out.world_from_map(), TPose2D(p.map_from_base.asTPose())));
  }
  return out;
}

}  // namespace rovigo::slam_localize
