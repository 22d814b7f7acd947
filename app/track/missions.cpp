#include "app/track/missions.h"

#include <vector>

#include "app/ground.h"
#include "app/plan_query.h"
#include "app/resources.h"
#include "app/route_drive.h"
#include "maps/distance_field.h"
#include "maps/error.h"
#include "sim/random.h"

namespace rovigo::app {

namespace {

constexpr double kShortestM = 1.0;
constexpr float kNearRecordedM = 1.0F;
constexpr int kDraws = 200;

maps::SavedMap true_map(const std::string& world, const RovigoConfig& config) {
  maps::SavedMap map;
  map.grid = obstacle_grid(open_world(world), config);
  map.metadata.simulation = {.world = world, .world_from_map = TPose2D()};
  return map;
}

PlannedTrack track_of(const planning::PlanResult& plan, std::shared_ptr<const maps::SavedMap> map) {
  const Ground ground = ground_of(*map, std::nullopt);
  return {ground.world, plan.trajectory, plan.trajectory.points.front().pose, ground.world_from_map,
          std::move(map)};
}

/// Where the rover may stand, whichever way it faces, with the margin of drives; on a recorded map
/// only near to where the recording went: what was seen from afar is mapped less well.
std::vector<TPoint2D> places_on(const maps::SavedMap& map, const RovigoConfig& config) {
  const maps::OccupancyGrid& grid = map.grid;
  const maps::DistanceField field = maps::distance_to_occupied(grid);
  const maps::DistanceField recorded = maps::distance_to_points(grid.geometry, recorded_way(map));
  const double room_m = config.robot.robot_radius_m + config.planning.drive_margin_m;
  std::vector<TPoint2D> places;
  for (int y = 0; y < grid.geometry.height; ++y) {
    for (int x = 0; x < grid.geometry.width; ++x) {
      const maps::Cell cell{x, y};
      if (!maps::OccupancyGrid::is_free(grid.at(cell))) continue;
      if (static_cast<double>(field.at(cell)) < room_m) continue;
      if (!map.trajectory.empty() && recorded.at(cell) > kNearRecordedM) continue;
      places.push_back(grid.geometry.center_of(cell));
    }
  }
  return places;
}

class MissionDraw {
 public:
  MissionDraw(std::vector<TPoint2D> places, std::uint64_t seed)
      : places_(std::move(places)), random_(sim::derive_seed(seed, kStream)) {}

  planning::PlanRequest next() {
    planning::PlanRequest request;
    request.start = place();
    request.goal = place();
    request.start_heading_given = true;
    request.goal_heading_given = random_.uniform(0.0, 1.0) < 0.5;
    return request;
  }

 private:
  static constexpr std::uint64_t kStream = 41;
  TPose2D place() {
    const TPoint2D& at = places_[random_.bits() % places_.size()];
    return {at.x, at.y, random_.uniform(-maps::kPi, maps::kPi)};
  }
  std::vector<TPoint2D> places_;
  sim::RandomStream random_;
};

}  // namespace

std::shared_ptr<const maps::SavedMap> open_track_map(const TrackShape& shape,
                                                     const std::filesystem::path& folder,
                                                     const RovigoConfig& config) {
  if (shape.map.empty()) {
    return std::make_shared<const maps::SavedMap>(true_map(shape.world, config));
  }
  constexpr bool kAsJson = true;  // only what it warns of is said, on stderr
  return std::make_shared<const maps::SavedMap>(
      open_planning_map(folder / shape.map, Console(kAsJson)));
}

PlannedTrack plan_goal(const std::string& name, const TrackShape& shape,
                       std::shared_ptr<const maps::SavedMap> map, const RovigoConfig& config) {
  planning::PlanRequest request;
  if (shape.map.empty()) {
    request.start = open_world(shape.world).start();
  } else if (!map->trajectory.empty()) {
    request.start = TPose2D(map->trajectory.front().map_from_base.asTPose());
  } else {
    throw maps::InputError("trajectory \"" + name + "\": " + shape.map +
                           " has no recorded trajectory to start from; take shape mission");
  }
  request.start_heading_given = true;
  request.goal = {shape.goal_x_m, shape.goal_y_m, 0.0};
  const planning::PlanResult plan = drive_planner_on(*map, config).plan(request);
  if (plan.status != planning::PlanStatus::kOk) {
    throw maps::InputError("trajectory \"" + name + "\" cannot be driven: " + plan.message);
  }
  return track_of(plan, std::move(map));
}

PlannedTrack draw_mission(const std::string& name, const TrackShape& shape,
                          std::shared_ptr<const maps::SavedMap> map, const RovigoConfig& config,
                          std::uint64_t seed) {
  if (!map) {
    map =
        std::make_shared<const maps::SavedMap>(true_map("random:" + std::to_string(seed), config));
  }
  const planning::DrivePlanner planner = drive_planner_on(*map, config);
  std::vector<TPoint2D> places = places_on(*map, config);
  if (!places.empty()) {
    MissionDraw draw(std::move(places), seed);
    for (int i = 0; i < kDraws; ++i) {
      const planning::PlanResult plan = planner.plan(draw.next());
      if (plan.status != planning::PlanStatus::kOk || plan.path_length_m < kShortestM) continue;
      return track_of(plan, std::move(map));
    }
  }
  throw maps::InputError("trajectory \"" + name + "\", seed " + std::to_string(seed) +
                         ": no two places a metre apart with a way between them in " +
                         (shape.map.empty() ? "world " + shape.world : shape.map));
}

}  // namespace rovigo::app
