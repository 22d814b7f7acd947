// rovigo plan: a path and a timed trajectory, one query or many.

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/commands/options.h"
#include "app/plan_query.h"
#include "app/query_batch.h"
#include "app/report/drive_report.h"
#include "app/report/map_picture.h"
#include "planning/footprint.h"

namespace rovigo::app {

namespace {

constexpr double kOutlineSpacingM = 0.25;  // of footprints in pictures

int exit_code(planning::PlanStatus status) {
  return status == planning::PlanStatus::kOk ? kDone : kDidNotSucceed;
}

nlohmann::ordered_json point_json(const planning::PointQueryResult& r) {
  nlohmann::ordered_json object{
      {"status", to_string(r.status)},
      {"code", planning::refusal_code(r.status)},
      {"message", r.status == planning::PlanStatus::kOk ? "found " + with_unit(r.length_m, 4, "m")
                                                        : r.message}};
  if (r.status == planning::PlanStatus::kOk) {
    object["search_length_m"] = r.length_m;
    object["path_length_m"] = r.length_m;
  } else if (r.nearest_reachable_goal) {
    object["nearest_reachable_goal"] = {r.nearest_reachable_goal->x, r.nearest_reachable_goal->y};
  }
  object["expanded_cells"] = r.expanded_cells;
  return object;
}

int plan_batch(const PlanOptions& options, const maps::SavedMap& map, const RovigoConfig& config) {
  const auto queries = read_query_batch(*options.batch, map.grid.geometry);
  std::optional<planning::PointPlanner> points;
  std::optional<planning::Planner> planner;
  if (options.point) {
    points.emplace(map.grid, config.inflation.map_mode);
  } else {
    planner.emplace(map.grid, config.robot, config.inflation, config.planning);
  }
  for (std::size_t i = 0; i < queries.size(); ++i) {
    nlohmann::ordered_json line{{"index", i}};
    if (points) {
      line.update(point_json(points->query(queries[i].start, queries[i].goal)));
    } else {
      planning::PlanRequest request;
      request.start = {queries[i].start.x, queries[i].start.y, 0.0};
      request.goal = {queries[i].goal.x, queries[i].goal.y, 0.0};
      request.seed = options.seed;
      line.update(plan_json(timed_plan([&](const auto& r) { return planner->plan(r); }, request)));
    }
    std::printf("%s\n", line.dump().c_str());
  }
  return kDone;
}

int plan_a_point(const PlanOptions& options, const maps::SavedMap& map, const RovigoConfig& config,
                 const Console& console) {
  const planning::PlanRequest request = plan_request(options.route, map);
  const auto result =
      planning::plan_point(map.grid, maps::position_of(request.start),
                           maps::position_of(request.goal), config.inflation.map_mode);
  const auto object = point_json(result);
  console.result(object, object["message"],
                 {{"cells expanded", std::to_string(result.expanded_cells)}});
  if (options.image) {
    MapPictureLayers layers = plan_layers(request, {});
    layers.planned_path = result.path.points;
    write_map_picture(*options.image, map.grid, layers);
  }
  return exit_code(result.status);
}

}  // namespace

int run_plan(const PlanOptions& options) {
  const Console console(options.json);
  const RovigoConfig config =
      with_route_options(load_config(options.config, options.set), options.route);
  const maps::SavedMap map = open_planning_map(options.map, console);
  if (options.batch) return plan_batch(options, map, config);
  if (options.point) return plan_a_point(options, map, config, console);

  planning::PlanRequest request = plan_request(options.route, map);
  request.seed = options.seed;
  const planning::Planner planner(map.grid, config.robot, config.inflation, config.planning);
  const TimedPlan plan = timed_plan([&](const auto& r) { return planner.plan(r); }, request);
  if (options.path && plan.result.status == planning::PlanStatus::kOk) {
    write_path_csv(*options.path, plan.result.trajectory);
  }
  if (options.image) {
    MapPictureLayers layers = plan_layers(request, plan.result);
    layers.costmap = planner.costmap();
    if (planning::plans_with_rectangle(config.planning)) {
      layers.footprints = planning::footprint_outlines(
          plan.result.trajectory, planning::footprint_of(config.robot), kOutlineSpacingM);
    }
    layers.title = plan_message(plan.result);
    write_map_picture(*options.image, map.grid, layers);
  }
  console.result(plan_json(plan), plan_message(plan.result), plan_rows(plan));
  return exit_code(plan.result.status);
}

}  // namespace rovigo::app
