#pragma once
// What `plan` and `drive` share: from written points to a plan, and from a plan to JSON and words.

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/commands/options.h"
#include "app/config.h"
#include "app/console.h"
#include "app/report/map_picture.h"
#include "maps/map_file.h"
#include "planning/drive_planner.h"

namespace rovigo::app {

/// The map with its no-go zones drawn into the grid as obstacles; warnings go to the console.
maps::SavedMap open_planning_map(const std::filesystem::path& path, const Console& console);

/// Where the rover was while the map was recorded.
std::vector<TPoint2D> recorded_way(const maps::SavedMap& map);

/// Plans that are to be driven on this map.
planning::DrivePlanner drive_planner_on(const maps::SavedMap& map, const RovigoConfig& config);

/// Settings with --planner and --map-mode applied. Throws InputError for values that do not exist.
RovigoConfig with_route_options(RovigoConfig config, const RouteRequest& route);

/// Throws InputError for a missing goal, for a missing start on a map without a trajectory, and for
/// malformed points.
planning::PlanRequest plan_request(const RouteRequest& route, const maps::SavedMap& map);

/// A plan and how long it took; timings stay outside every comparison.
struct TimedPlan {
  planning::PlanResult result;
  double search_ms = 0.0;
  double total_ms = 0.0;
};
TimedPlan timed_plan(const std::function<planning::PlanResult(const planning::PlanRequest&)>& plan,
                     planning::PlanRequest request);

nlohmann::ordered_json plan_json(const TimedPlan& plan);
std::vector<Row> plan_rows(const TimedPlan& plan);
std::string plan_message(const planning::PlanResult& plan);

/// Start, goal, stops and the planned path, ready to draw.
MapPictureLayers plan_layers(const planning::PlanRequest& request,
                             const planning::PlanResult& plan);

}  // namespace rovigo::app
