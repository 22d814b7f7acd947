#include "app/plan_query.h"

#include <mrpt/math/TPose3D.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "app/text.h"
#include "maps/error.h"
#include "maps/zones.h"

namespace rovigo::app {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

}  // namespace

maps::SavedMap open_planning_map(const std::filesystem::path& path, const Console& console) {
  std::vector<std::string> warnings;
  maps::SavedMap map = maps::load_any_map(path, warnings);
  for (const auto& warning : warnings) console.warn(warning);
  if (map.grid.geometry.size() == 0) {
    throw maps::InputError(path.string() +
                           ": holds no occupancy grid to plan on; map the recording again");
  }
  maps::apply_zones(map.grid, map.zones);
  return map;
}

std::vector<TPoint2D> recorded_way(const maps::SavedMap& map) {
  std::vector<TPoint2D> way;
  way.reserve(map.trajectory.size());
  for (const auto& stored : map.trajectory) {
    way.push_back(maps::position_of(TPose2D(stored.map_from_base.asTPose())));
  }
  return way;
}

planning::DrivePlanner drive_planner_on(const maps::SavedMap& map, const RovigoConfig& config) {
  return {map.grid, config.robot, config.inflation, config.planning, recorded_way(map)};
}

RovigoConfig with_route_options(RovigoConfig config, const RouteRequest& route) {
  if (route.planner) {
    if (!planning::parse_planner_kind(*route.planner)) {
      throw maps::InputError("--planner " + *route.planner +
                             ": must be astar, thetastar, rrtconnect, rrtstar, bitstar or prmstar");
    }
    config.planning.planner = *route.planner;
  }
  if (route.map_mode) {
    if (*route.map_mode < 0 || *route.map_mode > 2) {
      throw maps::InputError("--map-mode " + std::to_string(*route.map_mode) +
                             ": must be 0 (known-free ground), 1 (unknown too) or 2 (everything)");
    }
    config.inflation.map_mode = static_cast<maps::MapMode>(*route.map_mode);
  }
  return config;
}

planning::PlanRequest plan_request(const RouteRequest& route, const maps::SavedMap& map) {
  planning::PlanRequest request;
  if (route.start) {
    const PoseArgument start = parse_pose("--start", *route.start);
    request.start = start.pose;
    request.start_heading_given = start.has_heading;
  } else if (!map.trajectory.empty()) {
    request.start = TPose2D(map.trajectory.front().map_from_base.asTPose());
    request.start_heading_given = true;
  } else {
    throw maps::InputError("--start is needed: this map has no recorded trajectory to start from");
  }
  if (!route.goal)
    throw maps::InputError("--goal X,Y[,YAW] is needed, in metres and radians of the map frame");
  const PoseArgument goal = parse_pose("--goal", *route.goal);
  request.goal = goal.pose;
  request.goal_heading_given = goal.has_heading;
  for (const auto& via : route.via) request.via.push_back(parse_point("--via", via));
  if (route.order == "shortest") request.via_order = planning::ViaOrder::kShortest;
  return request;
}

TimedPlan timed_plan(const std::function<planning::PlanResult(const planning::PlanRequest&)>& plan,
                     planning::PlanRequest request) {
  TimedPlan timed;
  const auto begin = Clock::now();
  request.on_stage = [&](planning::PlanStage stage) {
    if (stage == planning::PlanStage::kSmooth) timed.search_ms = ms_since(begin);
  };
  timed.result = plan(request);
  timed.total_ms = ms_since(begin);
  if (timed.search_ms == 0.0) timed.search_ms = timed.total_ms;  // refused before smoothing
  return timed;
}

nlohmann::ordered_json plan_json(const TimedPlan& plan) {
  const planning::PlanResult& r = plan.result;
  nlohmann::ordered_json object{{"status", to_string(r.status)},
                                {"code", planning::refusal_code(r.status)},
                                {"message", plan_message(r)}};
  if (r.status == planning::PlanStatus::kOk) {
    object["search_length_m"] = r.search_length_m;
    object["path_length_m"] = r.path_length_m;
    object["min_clearance_m"] = r.min_clearance_m;
    object["duration_s"] = r.trajectory.duration_s();
    object["escape"] = r.escape;
    object["unsafe_samples"] = r.unsafe_samples;
  } else if (r.nearest_reachable_goal) {
    object["nearest_reachable_goal"] = {r.nearest_reachable_goal->x, r.nearest_reachable_goal->y};
  } else {
    object["nearest_reachable_goal"] = nullptr;
  }
  object["expanded_cells"] = r.expanded_cells;
  object["search_ms"] = plan.search_ms;
  object["total_ms"] = plan.total_ms;
  return object;
}

std::string plan_message(const planning::PlanResult& plan) {
  if (plan.status != planning::PlanStatus::kOk) return plan.message;
  const std::string note = plan.message.empty() ? "" : "; " + plan.message;
  return "planned " + with_unit(plan.path_length_m, 2, "m") + ", " +
         with_unit(plan.trajectory.duration_s(), 1, "s") + " to drive" + note;
}

std::vector<Row> plan_rows(const TimedPlan& plan) {
  const planning::PlanResult& r = plan.result;
  if (r.status != planning::PlanStatus::kOk) {
    std::vector<Row> rows{{"refusal code", std::to_string(planning::refusal_code(r.status))}};
    if (r.nearest_reachable_goal) {
      rows.push_back({"nearest reachable goal", with_unit(r.nearest_reachable_goal->x, 2, "") +
                                                    "," +
                                                    with_unit(r.nearest_reachable_goal->y, 2, "")});
    }
    return rows;
  }
  return {{"path", with_unit(r.path_length_m, 2, "m") + " (grid search " +
                       with_unit(r.search_length_m, 2, "m") + ")"},
          {"clearance",
           with_unit(r.min_clearance_m, 3, "m") + " at the narrowest, beyond the footprint"},
          {"effort", std::to_string(r.expanded_cells) + " cells, " +
                         with_unit(plan.search_ms, 1, "ms search") + ", " +
                         with_unit(plan.total_ms, 1, "ms in all")}};
}

MapPictureLayers plan_layers(const planning::PlanRequest& request,
                             const planning::PlanResult& plan) {
  MapPictureLayers layers;
  layers.planned_path = positions_of(plan.trajectory.points);
  layers.start = request.start;
  layers.goal = request.goal;
  layers.goal_heading_given = request.goal_heading_given;
  layers.via_points = request.via;
  return layers;
}

}  // namespace rovigo::app
