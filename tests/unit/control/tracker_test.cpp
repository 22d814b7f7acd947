#include "control/tracker.h"
#include "control/path_follower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "control/tracking_metrics.h"
#include "maps/settings.h"
#include "tests/unit/control/plant.h"

namespace rovigo::control {
namespace {

using testing::DriveSetup;
using testing::Plant;
using testing::PlantOptions;
using testing::TrajectoryBuilder;

struct Outcome {
  DriveLog log;
  DriveMetrics metrics;
};

Outcome drive(const planning::Trajectory& plan, const DriveSetup& setup = {},
              const PlantOptions& plant_options = {}, const ControlConfig& config = {},
              const TPose2D* start = nullptr) {
  Plant plant(plant_options, start ? *start : plan.points.front().pose);
  TrajectoryTracker tracker(config, {}, plan);
  Outcome run;
  run.log = run_drive(tracker, plant, setup);
  run.metrics = measure(run.log, plan, plan.points.back().pose, true);
  return run;
}

double speed_at(const DriveLog& log, double time) {
  for (const DriveStep& s : log.steps) {
    if (s.time_s >= time) return s.command.vx;
  }
  ADD_FAILURE() << "the drive was over before " << time << " s";
  return -1.0;
}

planning::Trajectory long_straight() { return TrajectoryBuilder({}, {}).line(4).get(); }

TEST(ControlConfig, DefaultsAreWithinTheirRanges) {
  EXPECT_NO_THROW(maps::validate(ControlConfig()));
}

TEST(Tracker, ASteadyPushToTheSideIsTakenOut) {
  const auto plan = TrajectoryBuilder({}, {}).line(6).get();
  DriveSetup setup;
  setup.disturb = [](double, Plant& plant) {  // 2 cm/s to the left while it drives, as on a slope
    TPose2D pose = plant.pose();
    if (plant.twist().vx > 0.02) pose.y += 0.02 * 0.01;
    plant.put(pose);
  };
  const Outcome run = drive(plan, setup);
  EXPECT_EQ(run.log.status, TrackStatus::kReached);
  double worst = 0.0;
  for (const DriveStep& s : run.log.steps) {
    if (s.true_pose.x > 3.0 && s.true_pose.x < 5.5) {
      worst = std::max(worst, std::abs(s.true_pose.y));
    }
  }
  // Without the integral: 2 cm/s over the loop's 1.8 1/s, 11 mm.
  EXPECT_LT(worst, 0.004);
}

TEST(Tracker, ATurnThatSlidOffItsPlaceReturnsThereSlowly) {
  const auto plan = TrajectoryBuilder({}, {}).turn(maps::kPi).get();
  DriveSetup setup;
  setup.disturb = [](double time, Plant& plant) {  // 5 cm to the right, once
    if (std::abs(time - 1.0) > 0.001) return;
    TPose2D pose = plant.pose();
    pose.y -= 0.05;
    plant.put(pose);
  };
  const Outcome run = drive(plan, setup);
  for (const DriveStep& s : run.log.steps) ASSERT_LE(std::abs(s.command.vx), kTurnBackSpeedMS);
  EXPECT_LT(std::abs(run.log.steps.back().true_pose.y), 0.02);
}

TEST(Tracker, OnASlopeItTurnsOnTheSpotAndDrivesStraight) {
  // Slides downhill, as far as that lies along the axles, while its wheels roll.
  const auto slide = [](double, Plant& plant) {
    constexpr double kDownX = 0.012, kDownY = -0.016;
    TPose2D pose = plant.pose();
    if (std::abs(plant.twist().vx) + 0.179 * std::abs(plant.twist().omega) < 0.02) return;
    const double nx = -std::sin(pose.phi), ny = std::cos(pose.phi);
    const double aside = (kDownX * nx + kDownY * ny) * 0.01;
    pose.x += aside * nx;
    pose.y += aside * ny;
    plant.put(pose);
  };
  TrajectoryBuilder builder({}, {});
  builder.line(1.5).turn(maps::kPi).line(1.5).turn(-maps::kPi / 2);
  DriveSetup setup{
      .pose_latency_s = 0.05, .position_noise_m = 0.005, .yaw_noise_rad = 0.005, .sigma_m = 0.005};
  setup.disturb = slide;
  const Outcome run = drive(builder.get(), setup);
  EXPECT_EQ(run.log.status, TrackStatus::kReached);
  double after_turn = 1.0, while_driving = 0.0;
  for (const DriveStep& step : run.log.steps) {
    const TPose2D& at = step.true_pose;
    if (after_turn == 1.0 && at.phi > 3.1) after_turn = std::hypot(at.x - 1.5, at.y);
    if (at.x > 0.6 && at.x < 1.3) while_driving = std::max(while_driving, std::abs(at.y));
  }
  EXPECT_LT(after_turn, 0.012);  // the slide of half a turn at 0.8 rad/s is 0.039
  EXPECT_LT(while_driving, 0.010);
  EXPECT_LT(run.metrics.final_position_error_m, 0.015);
}

TEST(Tracker, DrivesACurveAndStopsCleanlyAtTheGoal) {
  const Outcome run = drive(testing::moderate_curve({}));
  EXPECT_EQ(run.log.status, TrackStatus::kReached);
  EXPECT_LT(run.metrics.cross_track_rms_m, 0.002);
  EXPECT_LT(run.metrics.final_position_error_m, 0.005);
  EXPECT_LT(run.metrics.final_heading_error_rad, 0.01);
  EXPECT_LT(run.metrics.duration_s, run.metrics.planned_duration_s + 2.0);
  EXPECT_EQ(run.log.steps.back().command.vx, 0.0);
  EXPECT_NEAR(run.log.steps.back().true_twist.vx, 0.0, 1e-3);
}

TEST(Tracker, NeverDrivesBackwardsAndNeverOscillatesAtTheGoal) {
  DriveSetup noisy{
      .pose_latency_s = 0.1, .position_noise_m = 0.01, .yaw_noise_rad = 0.01, .sigma_m = 0.01};
  const Outcome run = drive(long_straight(), noisy, {.speed_gain = 1.1});
  EXPECT_EQ(run.log.status, TrackStatus::kReached);
  int starts = 0;
  for (std::size_t i = 1; i < run.log.steps.size(); ++i) {
    EXPECT_GE(run.log.steps[i].command.vx, 0.0);
    starts += run.log.steps[i - 1].command.vx == 0.0 && run.log.steps[i].command.vx > 0.0;
  }
  EXPECT_LE(starts, 3);
}

TEST(Tracker, TurnsFirstWhenTheHeadingIsFarOff) {
  for (const double yaw : {maps::kPi / 2, -2.5, 3.1, maps::kPi}) {
    const TPose2D start(0, 0, yaw);
    const Outcome run = drive(long_straight(), {}, {}, {}, &start);
    EXPECT_EQ(run.log.status, TrackStatus::kReached) << yaw;
    EXPECT_LT(run.metrics.cross_track_max_m, 0.02) << yaw;
    for (const DriveStep& s : run.log.steps) {
      if (std::abs(maps::wrap_angle(s.true_pose.phi)) > 0.6) {
        EXPECT_EQ(s.command.vx, 0.0) << yaw;
      }
    }
  }
}

TEST(Tracker, LargeTurnsDoNotOvershoot) {
  for (const double angle : {maps::kPi / 2, 2.36, maps::kPi, -2.9}) {
    const auto plan = TrajectoryBuilder({}, {}).turn(angle).get();
    const Outcome run = drive(plan);
    EXPECT_EQ(run.log.status, TrackStatus::kReached) << angle;
    EXPECT_LT(run.metrics.final_heading_error_rad, 0.012) << angle;
    for (const DriveStep& s : run.log.steps) {
      const double beyond = std::copysign(1.0, angle) *
                            maps::wrap_angle(s.true_pose.phi - plan.points.back().pose.phi);
      if (beyond < 1.0) {
        EXPECT_LT(beyond, 0.02) << angle;
      }
    }
  }
}

TEST(Tracker, TheReferenceWaitsForALateRover) {
  const auto plan = testing::square({});
  DriveSetup blocked;
  // Somebody holds the rover for three seconds on the first side.
  blocked.disturb = [held_at = TPose2D(), holding = false](double t, Plant& plant) mutable {
    if (t > 2 && t < 5) {
      if (!holding) held_at = plant.pose();
      holding = true;
      plant.put(held_at);
    }
  };
  const Outcome run = drive(plan, blocked);
  EXPECT_EQ(run.log.status, TrackStatus::kReached);
  EXPECT_LT(run.metrics.cross_track_max_m, 0.02);  // it cut no corner to catch up
  EXPECT_GT(run.metrics.duration_s, run.metrics.planned_duration_s + 2.0);
}

TEST(Tracker, StopsWithinAFifthOfASecondOfTheLastPoseAndGoesOn) {
  DriveSetup gap;
  gap.tamper = [](double t, PoseInput& pose) {
    if (t > 4.0 && t < 7.0) pose.time_s = 3.0;  // the stream stalls: an old pose is repeated
  };
  const Outcome run = drive(long_straight(), gap);
  EXPECT_GT(speed_at(run.log, 3.9), 0.35);
  EXPECT_EQ(speed_at(run.log, 4.2), 0.0);
  EXPECT_EQ(speed_at(run.log, 6.9), 0.0);
  EXPECT_LT(speed_at(run.log, 7.1), 0.1);  // from rest, not at once
  EXPECT_EQ(run.log.status, TrackStatus::kReached);
  EXPECT_LT(run.metrics.final_position_error_m, 0.01);
}

TEST(Tracker, StopsForPosesThatAreTwoSecondsLate) {
  const Outcome run = drive(long_straight(), {.pose_latency_s = 2.0, .longest_s = 15.0});
  for (const DriveStep& s : run.log.steps) ASSERT_EQ(s.command.vx, 0.0);
  EXPECT_EQ(run.log.status, TrackStatus::kPoseLost);
}

TEST(Tracker, DrivesSlowlyOnDoubtfulPosesAndStopsWhenTheyAreTooVague) {
  DriveSetup doubtful;
  doubtful.tamper = [](double t, PoseInput& pose) {
    if (t > 4.0) pose.quality = PoseQuality::kDoubtful;
    pose.sigma_position_m = t > 8.0 && t < 10.0 ? 0.12 : 0.05;
  };
  const Outcome run = drive(long_straight(), doubtful);
  EXPECT_GT(speed_at(run.log, 3.9), 0.35);
  for (const DriveStep& s : run.log.steps) {
    if (s.time_s > 4.0 + 0.25 / 0.5 + 0.1) {
      ASSERT_LE(s.command.vx, 0.15 + 1e-9) << s.time_s;
    }
  }
  EXPECT_GT(speed_at(run.log, 7.0), 0.1);
  EXPECT_EQ(speed_at(run.log, 8.25), 0.0);
  EXPECT_EQ(speed_at(run.log, 9.9), 0.0);
  EXPECT_EQ(run.log.status, TrackStatus::kReached);
}

TEST(Tracker, BrakesAtOnceWhenThePoseIsLost) {
  DriveSetup lost;
  lost.tamper = [](double t, PoseInput& pose) {
    if (t > 4.0) pose.quality = PoseQuality::kLost;
  };
  const Outcome run = drive(long_straight(), lost);
  EXPECT_LT(speed_at(run.log, 4.1), speed_at(run.log, 3.99));
  EXPECT_EQ(speed_at(run.log, 4.25), 0.0);
  EXPECT_EQ(run.log.status, TrackStatus::kPoseLost);
}

TEST(Tracker, APoseThatIsNotFiniteIsAsIfItHadNotCome) {
  DriveSetup nan;
  nan.tamper = [](double t, PoseInput& pose) {
    if (t > 4.0) pose.map_from_base.x = std::numeric_limits<double>::quiet_NaN();
  };
  const Outcome run = drive(long_straight(), nan);
  EXPECT_GT(speed_at(run.log, 4.1), 0.3);
  EXPECT_EQ(speed_at(run.log, 4.25), 0.0);
  EXPECT_EQ(run.log.status, TrackStatus::kPoseLost);
}

TEST(Tracker, GivesUpWhenTheWheelsSpin) {
  DriveSetup wall;
  wall.longest_s = 60.0;
  wall.disturb = [](double, Plant& plant) {
    if (plant.pose().x > 1.0) plant.put({1.0, plant.pose().y, plant.pose().phi});
  };
  const Outcome run = drive(long_straight(), wall);
  EXPECT_EQ(run.log.status, TrackStatus::kNoProgress);
  EXPECT_EQ(run.log.steps.back().command.vx, 0.0);
}

TEST(Tracker, StandsWhereNobodyPlannedADrive) {
  DriveSetup carried_off;
  carried_off.disturb = [done = false](double t, Plant& plant) mutable {
    if (done || t < 4.0) return;
    done = true;
    plant.put({plant.pose().x, plant.pose().y + 1.0, plant.pose().phi});
  };
  const Outcome run = drive(long_straight(), carried_off);
  EXPECT_EQ(run.log.status, TrackStatus::kNoProgress);
  EXPECT_EQ(speed_at(run.log, 6.0), 0.0);
}

TEST(Tracker, GoesOnWhenAWrongPoseIsTakenBack) {
  DriveSetup blip;
  blip.tamper = [](double t, PoseInput& pose) {
    if (t > 4.0 && t < 6.0) pose.map_from_base.y += 2.0;
  };
  const Outcome run = drive(long_straight(), blip);
  EXPECT_EQ(run.log.status, TrackStatus::kReached);
  EXPECT_LT(run.metrics.cross_track_max_m, 0.1);
}

TEST(Tracker, BelievesAJumpOnlyOfAGoodPose) {
  DriveSetup elsewhere;
  elsewhere.tamper = [](double t, PoseInput& pose) {
    if (t < 4.0 || t > 7.0) return;
    pose.quality = PoseQuality::kDoubtful;  // found again, it thinks, in the next room
    pose.sigma_position_m = 0.05;
    pose.map_from_base.x -= 3.5;
  };
  const Outcome run = drive(long_straight(), elsewhere);
  for (const DriveStep& s : run.log.steps) {
    if (s.time_s > 5.0 && s.time_s < 7.0) {
      ASSERT_EQ(s.command.vx, 0.0) << s.time_s;
    }
  }
  EXPECT_EQ(run.log.status, TrackStatus::kReached);
  EXPECT_LT(run.metrics.cross_track_max_m, 0.02);
}

TEST(Tracker, ADeadZoneLargerThanItKnowsOfDoesNotStallIt) {
  for (const double dead_zone_m_s : {0.06, 0.08}) {
    const auto plan = TrajectoryBuilder({}, {}).line(1.0).turn(0.08).line(0.3).turn(-1.2).get();
    const Outcome run = drive(plan, {.position_noise_m = 0.01, .yaw_noise_rad = 0.01},
                              {.dead_zone_m_s = dead_zone_m_s});
    EXPECT_EQ(run.log.status, TrackStatus::kReached) << dead_zone_m_s;
    EXPECT_LT(run.metrics.final_heading_error_rad, 0.06) << dead_zone_m_s;
  }
}

TEST(Tracker, TimesOutWhenFarBehindThePlan) {
  ControlConfig hasty;
  hasty.timeout_factor = 1.0;
  hasty.timeout_extra_s = 0.0;
  const Outcome run = drive(long_straight(), {}, {.speed_gain = 0.4}, hasty);
  EXPECT_EQ(run.log.status, TrackStatus::kTimedOut);
}

TEST(Tracker, ApproachesAMissedGoalAgainAndGoesBackwardsInTurnsOnly) {
  DriveSetup shoved;
  shoved.disturb = [done = false](double t, Plant& plant) mutable {
    if (!done && t > 3.0 && plant.twist().vx < 0.01) {
      done = true;  // pushed 8 cm beyond the goal and 6 cm aside while it settles
      plant.put({plant.pose().x + 0.08, plant.pose().y + 0.06, plant.pose().phi});
    }
  };
  const auto plan = TrajectoryBuilder({}, {}).line(1.0).get();
  const Outcome run = drive(plan, shoved);
  EXPECT_EQ(run.log.status, TrackStatus::kReached);
  EXPECT_LT(run.metrics.final_position_error_m, 0.02);
  EXPECT_LT(run.metrics.final_heading_error_rad, 0.05);
  for (const DriveStep& s : run.log.steps) {
    EXPECT_GE(s.command.vx, -kTurnBackSpeedMS);
    if (s.command.vx < -0.01) {
      EXPECT_EQ(s.reference.speed_m_s, 0.0);
    }
  }
}

TEST(Tracker, AnUnmovingTrajectoryIsReachedAtOnce) {
  planning::Trajectory here;
  here.points.push_back({});
  const Outcome run = drive(here);
  EXPECT_EQ(run.log.status, TrackStatus::kReached);
  EXPECT_LT(run.metrics.duration_s, 1.5);
}

TEST(Tracker, ADeadZoneDoesNotStallIt) {
  maps::RobotModel slow;
  slow.max_speed_m_s = 0.05;
  const auto plan = TrajectoryBuilder(slow, {}).line(0.5).get();
  ControlConfig config;
  config.dead_zone_speed_m_s = 0.09;
  Plant plant({.dead_zone_m_s = 0.08}, {});
  maps::RobotModel robot;  // may go faster than planned for the moments it moves
  TrajectoryTracker tracker(config, robot, plan);
  const DriveLog log = run_drive(tracker, plant, {});
  EXPECT_EQ(log.status, TrackStatus::kReached);
  EXPECT_LT(measure(log, plan, plan.points.back().pose, true).final_position_error_m, 0.02);
}

TEST(Tracker, SameInputSameCommands) {
  DriveSetup noisy{.position_noise_m = 0.01, .yaw_noise_rad = 0.01};
  const Outcome a = drive(testing::slalom({}), noisy), b = drive(testing::slalom({}), noisy);
  ASSERT_EQ(a.log.steps.size(), b.log.steps.size());
  for (std::size_t i = 0; i < a.log.steps.size(); ++i) {
    ASSERT_EQ(a.log.steps[i].command.vx, b.log.steps[i].command.vx);
    ASSERT_EQ(a.log.steps[i].command.omega, b.log.steps[i].command.omega);
  }
}

}  // namespace
}  // namespace rovigo::control
