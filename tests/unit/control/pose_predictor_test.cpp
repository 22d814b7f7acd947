#include "control/pose_predictor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "control/turn_gain.h"
#include "tests/unit/control/plant.h"

namespace rovigo::control {
namespace {

constexpr double kStepS = 0.01;

TEST(PosePredictor, FollowsAPlantItModelsExactly) {
  testing::Plant plant({.lag_s = 0.08, .command_delay_s = 0.05}, {1, 2, 3});
  PosePredictor predictor({.lag_s = 0.08, .command_delay_s = 0.05});
  predictor.reset(0.0, plant.pose());
  predictor.advance(0.0);
  for (int i = 0; i < 150; ++i) {
    const TTwist2D command(0.2 + 0.1 * std::sin(0.1 * i), 0, 0.8 * std::cos(0.07 * i));
    predictor.set_command(command);
    plant.step(command, kStepS);
    predictor.advance(plant.time_s());
  }
  const TPose2D guess = predictor.at(plant.time_s());
  EXPECT_NEAR(guess.x, plant.pose().x, 2e-3);
  EXPECT_NEAR(guess.y, plant.pose().y, 2e-3);
  EXPECT_NEAR(guess.phi, plant.pose().phi, 6e-3);
}

TEST(PosePredictor, BringsAnOldPoseUpToDate) {
  PosePredictor predictor({.lag_s = 0.0, .command_delay_s = 0.0});
  predictor.advance(0.0);
  predictor.set_command({0.4, 0, 0});
  for (int i = 1; i <= 50; ++i) predictor.advance(i * kStepS);
  predictor.reset(0.3, {10, 0, 0});  // held 0.2 s ago
  EXPECT_NEAR(predictor.at(0.5).x, 10.08, 1e-9);
  EXPECT_NEAR(predictor.at(0.4).x, 10.04, 1e-9);
}

TEST(PosePredictor, TurnsOnAnArc) {
  PosePredictor predictor({.lag_s = 0.0, .command_delay_s = 0.0});
  predictor.advance(0.0);
  predictor.reset(0.0, {0, 0, 0});
  predictor.set_command({0.5, 0, 0.5});
  predictor.advance(2.0);  // radius 1 m, one radian
  const TPose2D end = predictor.at(2.0);
  EXPECT_NEAR(end.x, std::sin(1.0), 1e-9);
  EXPECT_NEAR(end.y, 1 - std::cos(1.0), 1e-9);
}

TEST(PosePredictor, TakesItsShareOfACorrectionTheShortWayRound) {
  PosePredictor predictor({.lag_s = 0.05, .command_delay_s = 0.0});
  predictor.reset(0.0, {0, 0, maps::kPi - 0.1});
  predictor.correct(0.0, {1, 0, -maps::kPi + 0.1}, 0.5);
  EXPECT_NEAR(predictor.at(0.0).x, 0.5, 1e-12);
  EXPECT_NEAR(std::abs(predictor.at(0.0).phi), maps::kPi, 1e-9);
}

TEST(PosePredictor, IgnoresAClockThatRunsBackwards) {
  PosePredictor predictor({.lag_s = 0.05, .command_delay_s = 0.0});
  predictor.advance(5.0);
  predictor.set_command({0.4, 0, 0});
  predictor.advance(4.0);
  predictor.reset(5.0, {0, 0, 0});
  EXPECT_EQ(predictor.at(5.0).x, 0.0);
}

TEST(PosePredictor, KnowsThatStictionHoldsAStandingWheel) {
  PosePredictor predictor({.lag_s = 0.05, .dead_zone_m_s = 0.05});
  predictor.reset(0.0, {0, 0, 0});
  predictor.advance(0.0);
  predictor.set_command({0.04, 0, 0});
  predictor.advance(1.0);
  EXPECT_EQ(predictor.at(1.0).x, 0.0);
  predictor.set_command({0.06, 0, 0});
  predictor.advance(2.0);
  predictor.set_command({0.04, 0, 0});  // moving already: goes on
  predictor.advance(3.0);
  EXPECT_NEAR(predictor.twist().vx, 0.04, 1e-6);
}

TEST(PosePredictor, AWheelFoundStandingTurnsOnlyWhenAskedForMoreThanItsDeadZone) {
  PosePredictor predictor({.lag_s = 0.06, .command_delay_s = 0.0, .dead_zone_m_s = 0.04});
  predictor.advance(0.0);
  predictor.set_command({0.08, 0, 0});
  predictor.advance(1.0);
  EXPECT_NEAR(predictor.twist().vx, 0.08, 1e-6);
  predictor.set_dead_zone(0.1);
  predictor.advance(1.5);
  EXPECT_NEAR(predictor.twist().vx, 0.08, 1e-6) << "what moves is taken to go on";
  predictor.stop();
  predictor.advance(2.0);
  EXPECT_EQ(predictor.twist().vx, 0.0);
  predictor.set_command({0.12, 0, 0});
  predictor.advance(3.0);
  EXPECT_NEAR(predictor.twist().vx, 0.12, 1e-6);
}

TEST(TurnGain, LearnsWhatScrubbingEats) {
  testing::Plant plant({.yaw_gain = 0.85}, {});
  PosePredictor predictor({.lag_s = 0.06, .command_delay_s = 0.0});
  TurnGainEstimator estimator;
  predictor.advance(0.0);
  for (int i = 0; i < 500; ++i) {
    const TTwist2D command(0, 0, i % 200 < 100 ? 0.8 : -0.5);
    predictor.set_command(command);
    plant.step(command, kStepS);
    predictor.advance(plant.time_s());
    if (i % 3 == 0) estimator.add(plant.time_s(), plant.pose().phi, predictor);
  }
  EXPECT_NEAR(estimator.gain(), 0.85, 0.02);
}

TEST(TurnGain, StaysWithinBoundsOverJumpsOfTheEstimate) {
  PosePredictor predictor({.lag_s = 0.06, .command_delay_s = 0.0});
  TurnGainEstimator estimator;
  predictor.advance(0.0);
  predictor.set_command({0, 0, 0.5});
  for (int i = 1; i < 300; ++i) {
    predictor.advance(i * 0.03);
    estimator.add(i * 0.03, (i * 7919) % 6 - 3.0, predictor);
    ASSERT_GE(estimator.gain(), TurnGainEstimator::kLowest);
    ASSERT_LE(estimator.gain(), TurnGainEstimator::kHighest);
  }
}

TEST(TurnGain, KnowsNothingFromStraightDriving) {
  PosePredictor predictor({.lag_s = 0.06, .command_delay_s = 0.0});
  TurnGainEstimator estimator;
  predictor.advance(0.0);
  predictor.set_command({0.4, 0, 0.01});
  for (int i = 1; i < 300; ++i) {
    predictor.advance(i * 0.03);
    estimator.add(i * 0.03, 0.0, predictor);
  }
  EXPECT_EQ(estimator.gain(), 1.0);
}

}  // namespace
}  // namespace rovigo::control
