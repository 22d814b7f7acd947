// A drive whose pose is lost on the way, through the closed loop of `drive` and `track`: it stops,
// looks around, plans anew from where it finds itself, and arrives.

#include <gtest/gtest.h>

#include <cmath>

#include "app/drive_recovery.h"
#include "app/plan_query.h"
#include "control/tracker.h"
#include "control/tracking_metrics.h"
#include "tests/unit/control/simulated_drive.h"

namespace rovigo::app {
namespace {

/// The truth, until the rover has come so far; then nothing, until it has looked another way, if
/// that helps.
class ForgetfulPoses final : public PoseSource {
 public:
  ForgetfulPoses(const sim::Simulator& simulator, double forgets_at_x_m, bool finds_again)
      : simulator_(simulator), forgets_at_x_m_(forgets_at_x_m), finds_again_(finds_again) {}

  void observe(const mrpt::obs::CObservation&) override {}
  control::PoseInput pose(double now_s) override {
    const TPose2D truth(simulator_.truth().world_from_base.asTPose());
    if (!lost_heading_rad_ && truth.x > forgets_at_x_m_) lost_heading_rad_ = truth.phi;
    const bool looked_away =
        lost_heading_rad_ && std::abs(maps::wrap_angle(truth.phi - *lost_heading_rad_)) > 1.5;
    found_ |= finds_again_ && looked_away;
    const bool known = !lost_heading_rad_ || found_;
    return {now_s, truth, known ? 0.01 : 0.5,
            known ? control::PoseQuality::kGood : control::PoseQuality::kLost};
  }

 private:
  const sim::Simulator& simulator_;
  double forgets_at_x_m_;
  bool finds_again_;
  std::optional<double> lost_heading_rad_;
  bool found_ = false;
};

maps::SavedMap open_floor() {
  maps::SavedMap map;
  maps::GridGeometry g;
  g.resolution_m = 0.05;
  g.origin = {-3.0, -3.0};
  g.width = 200;
  g.height = 120;
  map.grid = maps::OccupancyGrid(g, maps::OccupancyGrid::kFree);
  return map;
}

struct Drive {
  control::DriveLog log;
  planning::Trajectory planned;
  control::DriveMetrics metrics;
};

Drive drive(double forgets_at_x_m, bool finds_again) {
  static const sim::World world = control::testing::empty_hall();
  const maps::SavedMap map = open_floor();
  const RovigoConfig config;
  planning::PlanRequest request;
  request.start = {0.0, 0.0, 0.0};
  request.start_heading_given = true;
  request.goal = {4.0, 1.0, 0.5};
  request.goal_heading_given = true;
  const auto plan = drive_planner_on(map, config).plan(request);
  EXPECT_EQ(plan.status, planning::PlanStatus::kOk) << plan.message;

  sim::SimulatorOptions options;
  options.robot = config.robot;
  options.camera_enabled = false;
  sim::Simulator simulator(world, options);
  ForgetfulPoses poses(simulator, forgets_at_x_m, finds_again);
  const auto make_tracker = [&config](const planning::Trajectory& trajectory) {
    return std::make_unique<control::TrajectoryTracker>(config.control, config.robot, trajectory);
  };
  const auto tracker = make_tracker(plan.trajectory);
  Replanner replanner(map, config, request, plan.trajectory, make_tracker);
  DriveHooks hooks;
  hooks.recovery = replanner.recovery(request.start.phi);
  Drive out;
  out.log = drive_in_simulator(simulator, {}, poses, *tracker, plan.trajectory.duration_s(), config,
                               hooks);
  out.planned = replanner.planned();
  out.metrics = control::measure(out.log, out.planned, request.goal, true, {});
  return out;
}

TEST(DriveRecovery, LooksAroundPlansAnewAndArrives) {
  const Drive drive = app::drive(1.5, true);
  EXPECT_EQ(drive.log.status, control::TrackStatus::kReached);
  EXPECT_EQ(drive.log.looked_around, 1);
  EXPECT_LE(drive.metrics.final_position_error_m, 0.03);
  EXPECT_LE(drive.metrics.cross_track_max_m, 0.10);  // from one way to the next, stopping
}

TEST(DriveRecovery, StandsStillBeforeItLooksAround) {
  const Drive drive = app::drive(1.5, true);
  std::optional<double> lost_s;
  for (const control::DriveStep& s : drive.log.steps) {
    const bool lost = s.quality == control::PoseQuality::kLost;
    if (lost && !lost_s) lost_s = s.time_s;
    if (!lost || s.time_s - *lost_s < 0.3) continue;
    EXPECT_EQ(s.command.vx, 0.0) << "at " << s.time_s;
  }
  EXPECT_TRUE(lost_s);
}

TEST(DriveRecovery, EndsWithTheTruthWhereNothingIsFound) {
  const Drive drive = app::drive(1.5, false);
  EXPECT_EQ(drive.log.status, control::TrackStatus::kPoseLost);
  EXPECT_EQ(drive.log.looked_around, 1);
}

TEST(DriveRecovery, ChangesNothingWhereThePoseIsKnown) {
  const Drive drive = app::drive(100.0, true);
  EXPECT_EQ(drive.log.status, control::TrackStatus::kReached);
  EXPECT_EQ(drive.log.looked_around, 0);
  EXPECT_LE(drive.metrics.cross_track_rms_m, 0.01);
}

}  // namespace
}  // namespace rovigo::app
