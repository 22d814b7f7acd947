// rovigo drive: plans, then drives the plan in the simulator on the estimator's poses.

#include <nlohmann/json.hpp>

#include "app/commands/options.h"
#include "app/drive_outcome.h"
#include "app/drive_recovery.h"
#include "app/ground.h"
#include "app/plan_query.h"
#include "app/report/drive_report.h"
#include "app/resources.h"
#include "app/simulated_drive.h"
#include "maps/error.h"

namespace rovigo::app {

namespace {

std::vector<Row> drive_rows(const control::DriveLog& log, const control::DriveMetrics& m) {
  return {{"driven", with_unit(m.driven_length_m, 2, "m") + " of " +
                         with_unit(m.path_length_m, 2, "m planned") + ", " +
                         with_unit(m.duration_s, 1, "s")},
          {"cross-track", with_unit(m.cross_track_rms_m, 4, "m RMS") + ", " +
                              with_unit(m.cross_track_max_m, 4, "m at most")},
          {"at the goal",
           with_unit(m.final_position_error_m, 4, "m") +
               (m.goal_heading_given ? ", " + with_unit(m.final_heading_error_rad, 4, "rad") : "")},
          {"pose estimate", with_unit(m.estimate_rms_m, 4, "m RMS off the truth")},
          {"collisions", std::to_string(log.contact_events)},
          {"log hash", log_hash(log)}};
}

}  // namespace

int run_drive(const DriveOptions& options) {
  const Console console(options.json);
  const RovigoConfig config =
      with_route_options(load_config(options.config, options.set), options.route);
  if (planning::plans_with_rectangle(config.planning)) {
    throw maps::InputError(
        "planning.footprint = rectangle plans nearer to obstacles than a drive's errors allow: "
        "look at it with `rovigo plan`, drive with planning.footprint = circle");
  }
  const maps::SavedMap map = open_planning_map(options.map, console);
  planning::PlanRequest request = plan_request(options.route, map);
  request.seed = options.seed;
  const planning::DrivePlanner planner = drive_planner_on(map, config);
  const TimedPlan plan = timed_plan([&](const auto& r) { return planner.plan(r); }, request);
  if (plan.result.status != planning::PlanStatus::kOk) {
    console.result(plan_json(plan), plan_message(plan.result), plan_rows(plan));
    return kDidNotSucceed;
  }
  if (plan.result.unsafe_samples > 0) {
    // A reference spline may cut through a wall: it is there to be looked at.
    nlohmann::ordered_json refusal = plan_json(plan);
    refusal["status"] = "unsafe_plan";
    refusal["code"] = planning::refusal_code(planning::PlanStatus::kNoPath);
    console.result(refusal, "not driven: " + plan_message(plan.result), plan_rows(plan));
    return kDidNotSucceed;
  }
  console.say(plan_message(plan.result));

  const Ground ground = ground_of(map, options.world);
  const std::string pose_kind = options.pose.value_or(map.keyframes.empty() ? "odometry" : "slam");
  const TPose2D start = plan.result.trajectory.points.front().pose;
  sim::SimulatorOptions simulation;
  simulation.robot = config.robot;
  simulation.scenario = open_scenario(options.scenario);
  simulation.world_from_base = maps::compose(ground.world_from_map, start);
  simulation.seed = options.seed;
  simulation.camera_rate_hz = kDriveCameraHz;
  simulation.camera_enabled = needs_camera(pose_kind);
  sim::Simulator simulator(ground.world, simulation);
  const auto poses = open_poses(
      {.kind = pose_kind, .map_name = options.map.string(), .start = start, .seed = options.seed},
      config, map, ground.world_from_map, simulator, simulation.scenario);

  const auto make_tracker = [&config](const planning::Trajectory& trajectory) {
    return std::make_unique<control::TrajectoryTracker>(config.control, config.robot, trajectory);
  };
  const auto tracker = make_tracker(plan.result.trajectory);
  Replanner replanner(map, config, request, plan.result.trajectory, make_tracker);
  control::DriveLog log;
  {
    Progress progress("driving");
    DriveHooks hooks;
    hooks.progress = [&](double share) { progress.update(share); };
    if (finds_itself(pose_kind)) hooks.recovery = replanner.recovery(start.phi);
    log = drive_in_simulator(simulator, ground.world_from_map, *poses, *tracker,
                             plan.result.trajectory.duration_s(), config, hooks);
  }
  if (!log.start_known) {
    console.warn("the start was not recognised, not even by looking around");
  }
  const control::CommandLimits limits{config.robot.max_speed_m_s, config.robot.max_yaw_rate_rad_s};
  const control::DriveMetrics metrics =
      control::measure(log, replanner.planned(), request.goal, request.goal_heading_given, limits);
  const Outcome outcome = outcome_of(log, metrics);
  const auto object = drive_json(outcome, log, metrics);

  if (options.report) {
    DriveReportInput report;
    report.title = "Drive to (" + with_unit(request.goal.x, 2, "") + ", " +
                   with_unit(request.goal.y, 2, "") + ")";
    report.summary = outcome.message;
    report.succeeded = outcome.code == 0;
    report.grid = map.grid;
    report.layers = plan_layers(request, plan.result);
    report.layers.costmap = planner.costmap();
    report.planned = replanner.planned();
    report.log = log;
    report.metrics = metrics;
    report.limits = limits;
    report.checks = {{"Cross-track error, RMS", metrics.cross_track_rms_m, 0.03, "m"},
                     {"Final position error", metrics.final_position_error_m, 0.05, "m"},
                     {"Collisions", static_cast<double>(log.contact_events), 0.0, ""}};
    report.facts = {{"Map", options.map.filename().string()},
                    {"World", ground.name},
                    {"Pose source", pose_kind},
                    {"Scenario", options.scenario},
                    {"Seed", std::to_string(options.seed)}};
    report.drive_json = object.dump(2);
    write_drive_report(*options.report, report);
    console.say("report: " + (*options.report / "index.html").string());
  }
  console.result(object, outcome.message, drive_rows(log, metrics));
  return outcome.code == 0 ? kDone : kDidNotSucceed;
}

}  // namespace rovigo::app
