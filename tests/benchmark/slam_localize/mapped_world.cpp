#include "mapped_world.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "app/resources.h"
#include "app/simulated_drive.h"
#include "maps/error.h"
#include "planning/free_space.h"
#include "planning/planner.h"
#include "recordings.h"
#include "slam/recording/recording.h"
#include "slam/slam.h"

namespace rovigo::slam_localize {

namespace {

constexpr double kTourSpeedMS = 0.4;
constexpr double kSeenWithinM = 1.5;
constexpr std::uint64_t kTourSeed = 1;

/// Passable cells that can be reached from `start`.
std::vector<TPoint2D> reachable(const maps::Costmap& costmap, const TPoint2D& start) {
  const maps::GridGeometry& g = costmap.geometry;
  std::vector<bool> seen(g.size(), false);
  std::queue<maps::Cell> open;
  open.push(g.cell_at(start));
  std::vector<TPoint2D> out;
  while (!open.empty()) {
    const maps::Cell c = open.front();
    open.pop();
    if (!costmap.is_passable(c) || seen[g.index_of(c)]) continue;
    seen[g.index_of(c)] = true;
    out.push_back(g.center_of(c));
    for (const maps::Cell d : {maps::Cell{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      open.push({c.x + d.x, c.y + d.y});
    }
  }
  return out;
}

/// Greedy cover: ground that no chosen place sees from close by gets a place of its own.
std::vector<TPoint2D> covering_places(const planning::Planner& planner, const TPoint2D& start) {
  const maps::Costmap& costmap = planner.costmap();
  const planning::FreeSpace line_of_sight(planner.grid(), costmap, 0.0);
  std::vector<TPoint2D> chosen{start};
  for (const TPoint2D& p : reachable(costmap, start)) {
    const bool seen = std::any_of(chosen.begin(), chosen.end(), [&](const TPoint2D& q) {
      return maps::distance(p, q) < kSeenWithinM && line_of_sight.is_free(p, q);
    });
    if (!seen) chosen.push_back(p);
  }
  chosen.erase(chosen.begin());
  return chosen;
}

planning::PlanRequest tour_request(const std::string& name, const sim::World& world,
                                   const planning::Planner& planner) {
  planning::PlanRequest request;
  if (name == "lab") {
    const auto route = app::open_route("lab_tour");
    const auto& p = route.waypoints;
    request.start = {p[0].x, p[0].y, std::atan2(p[1].y - p[0].y, p[1].x - p[0].x)};
    request.via.assign(p.begin() + 1, p.end() - 1);
    request.goal = {p.back().x, p.back().y, 0.0};
  } else {
    request.start = request.goal = world.start();
    request.via = covering_places(planner, maps::position_of(world.start()));
    request.via_order = planning::ViaOrder::kShortest;
  }
  request.start_heading_given = true;
  return request;
}

}  // namespace

planning::Trajectory plan_tour(const std::string& name, const sim::World& world,
                               const maps::OccupancyGrid& grid, const app::RovigoConfig& config) {
  app::RovigoConfig limited = config;
  limited.robot.max_speed_m_s = std::min(config.robot.max_speed_m_s, kTourSpeedMS);
  limited.inflation.robot_radius_m += 0.03;  // the tracker is not perfect
  const planning::Planner planner(grid, limited.robot, limited.inflation, limited.planning);
  const planning::PlanResult plan = planner.plan(tour_request(name, world, planner));
  if (plan.status != planning::PlanStatus::kOk) {
    throw maps::InputError("no mapping tour in world " + name + ": " + plan.message);
  }
  return plan.trajectory;
}

MappedWorld open_mapped_world(const std::string& name, const std::filesystem::path& folder,
                              const app::RovigoConfig& config, bool remap) {
  std::filesystem::create_directories(folder);
  const sim::World world = app::open_world(name);
  MappedWorld out{name, folder, world, {}, {}, {}};
  out.true_grid =
      sim::true_grid(world, config.slam.grid.grid_resolution_m, 0.02, config.robot.body_height_m);
  const auto recording = folder / "tour.rawlog";
  const auto map_file = folder / "map.rovigo";
  if (!std::filesystem::exists(recording)) {
    record_drive(world, name, plan_tour(name, world, out.true_grid, config), sim::Scenario{},
                 kTourSeed, config, recording);
    remap = true;
  }
  if (remap || !std::filesystem::exists(map_file)) {
    const auto reader = slam::open_recording(recording);
    slam::Slam slam(config.slam, reader->info().rig);
    while (const auto observation = reader->next()) slam.process(*observation);
    maps::SavedMap map = slam.finish();
    map.metadata.simulation = reader->info().simulation;
    maps::save_map(map, map_file);
  }
  out.map = maps::load_map(map_file);
  for (const maps::StoredPose& p : out.map.trajectory) {
    out.driven.push_back(maps::compose(out.world_from_map(), TPose2D(p.map_from_base.asTPose())));
  }
  return out;
}

}  // namespace rovigo::slam_localize
