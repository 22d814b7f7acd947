#include "control/reference_controller.h"

#include <gtest/gtest.h>

#include <cmath>

#include "maps/settings.h"
#include "tests/unit/control/plant.h"

namespace rovigo::control {
namespace {

/// 101 points along a moderate curve of 1.88 m.
std::vector<TPoint2D> experiment_path(double yaw) {
  std::vector<TPoint2D> path;
  TPose2D at(0, 0, yaw);
  for (int i = 0; i <= 100; ++i) {
    path.push_back(maps::position_of(at));
    constexpr double kStepM = 0.0188;
    at.phi += 0.8 * std::sin(2 * maps::kPi * i / 100.0) * kStepM;
    at.x += kStepM * std::cos(at.phi);
    at.y += kStepM * std::sin(at.phi);
  }
  return path;
}

struct Drive {
  double duration_s = 0.0;
  double length_m = 0.0;
  double miss_m = 0.0;
  bool finished = false;
};

Drive drive(const std::vector<TPoint2D>& path, const TPose2D& start) {
  testing::Plant plant({}, start);
  ReferenceController controller({}, path);
  Drive result;
  TPoint2D last = maps::position_of(start);
  while (!result.finished && result.duration_s < 60.0) {
    const auto out = controller.step(plant.pose());
    result.finished = out.finished;
    plant.step(out.command, ReferenceController::kStepS);
    result.duration_s += ReferenceController::kStepS;
    result.length_m += maps::distance(last, maps::position_of(plant.pose()));
    last = maps::position_of(plant.pose());
  }
  result.miss_m = maps::distance(last, path.back());
  return result;
}

TEST(ReferenceController, RepeatsTheThesissExperiment) {
  // Mission R12: 1.88 m in about 13 s, the first heading 90 deg off.
  const Drive run = drive(experiment_path(0.0), {0, 0, maps::kPi / 2});
  EXPECT_TRUE(run.finished);
  EXPECT_NEAR(run.duration_s, 13.0, 0.15 * 13.0);
  EXPECT_NEAR(run.miss_m, 0.15, 0.08);  // it stops a tolerance short of its goal
}

TEST(ReferenceController, DrivesAwayFromGoalsAtSmallerX) {
  EXPECT_FALSE(drive(experiment_path(maps::kPi), {0, 0, maps::kPi}).finished);
}

TEST(ReferenceController, DoesNotWrapItsHeadingError) {
  ReferenceController controller({}, std::vector<TPoint2D>(20, TPoint2D(-1.0, -0.1)));
  const auto out = controller.step({0, 0, 3.1});  // 0.1 rad off in truth
  EXPECT_GT(std::abs(out.heading_error_rad), 6.0);
  EXPECT_EQ(std::abs(out.command.omega), 0.4);
}

TEST(ReferenceController, IntegratorForgetsAtOnce) {
  // I = ki (e + I) has the fixed point e ki / (1 - ki): a tenth of the error, never more.
  ReferenceController controller({}, std::vector<TPoint2D>(20, TPoint2D(1.0, 0.0)));
  TTwist2D last;
  for (int i = 0; i < 1000; ++i) last = controller.step({0, 0, -0.1}).command;
  EXPECT_NEAR(last.omega, 0.1 * (0.75 + 0.1 / 0.9), 1e-9);
}

TEST(ReferenceController, ShortPathsAreFinishedAtOnce) {
  ReferenceController controller({}, {{0, 0}, {1, 0}});
  EXPECT_TRUE(controller.step({0, 0, 0}).finished);
  ReferenceController nothing({}, {});
  EXPECT_TRUE(nothing.step({0, 0, 0}).finished);
}

TEST(ReferenceConfig, DefaultsAreWithinTheirRanges) {
  EXPECT_NO_THROW(maps::validate(ReferenceConfig()));
}

}  // namespace
}  // namespace rovigo::control
