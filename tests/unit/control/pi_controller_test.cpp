#include "control/pi_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rovigo::control {
namespace {

PiInput input(double error, double dt = 0.01) {
  return {.error = error, .dt_s = dt, .min = -1.0, .max = 1.0, .integral_limit = 10.0};
}

TEST(PiController, IntegratesAtTheGivenRate) {
  PiController pi({.kp = 0.0, .ki = 2.0});
  for (int i = 0; i < 100; ++i) pi.update(input(0.1));
  EXPECT_NEAR(pi.integral(), 0.2, 1e-12);
}

TEST(PiController, GivesTheSameWhateverTheTimeStep) {
  PiController coarse({.kp = 1.0, .ki = 2.0}), fine({.kp = 1.0, .ki = 2.0});
  for (int i = 0; i < 10; ++i) coarse.update(input(0.1, 0.05));
  for (int i = 0; i < 100; ++i) fine.update(input(0.1, 0.005));
  EXPECT_NEAR(coarse.integral(), fine.integral(), 1e-12);
}

TEST(PiController, StandsStillAtSaturationByTheProportionalPart) {
  PiController pi({.kp = 5.0, .ki = 3.0});
  for (int i = 0; i < 10000; ++i) EXPECT_EQ(pi.update(input(1.0)), 1.0);
  EXPECT_EQ(pi.integral(), 0.0);
}

TEST(PiController, LeavesSaturationAtOnceWhenTheErrorTurns) {
  PiController pi({.kp = 0.5, .ki = 1.0});
  for (int i = 0; i < 2000; ++i) pi.update(input(1.0));
  EXPECT_EQ(pi.update(input(1.0)), 1.0);
  // 20 s of saturation would have wound a plain integrator up to 20.
  EXPECT_LT(pi.integral(), 0.51);
  EXPECT_LT(pi.update(input(-0.2)), 0.5);
}

TEST(PiController, GivesBackItsOwnShareOfTheExcess) {
  PiController pi({.kp = 0.0, .ki = 1.0, .anti_windup_time_s = 0.1});
  for (int i = 0; i < 90; ++i) pi.update(input(1.0));
  ASSERT_NEAR(pi.integral(), 0.9, 1e-9);
  PiInput tighter = input(0.0);
  tighter.max = 0.3;
  for (int i = 0; i < 200; ++i) pi.update(tighter);
  EXPECT_NEAR(pi.integral(), 0.3, 1e-3);
}

TEST(PiController, GivesWayToSaturationDownTheLine) {
  PiController pi({.kp = 0.0, .ki = 1.0, .anti_windup_time_s = 0.1});
  for (int i = 0; i < 50; ++i) pi.update(input(1.0));
  const double before = pi.integral();
  pi.back_calculate(-1.0, 0.01);  // too small asked: nothing of a positive integral to give
  EXPECT_EQ(pi.integral(), before);
  pi.back_calculate(0.2, 0.01);
  EXPECT_NEAR(pi.integral(), before - 0.02, 1e-12);
}

TEST(PiController, FeedForwardCountsTowardsTheLimits) {
  PiController pi({.kp = 1.0, .ki = 1.0});
  PiInput in = input(0.5);
  in.feed_forward = 0.9;
  EXPECT_EQ(pi.update(in), 1.0);
  EXPECT_EQ(pi.integral(), 0.0);
}

TEST(PiController, SurvivesTimeStepsThatMakeNoSense) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  PiController pi({.kp = 0.1, .ki = 1.0});
  for (const double dt : {0.0, -1.0, kNan, -std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(std::isfinite(pi.update(input(0.5, dt)))) << dt;
    EXPECT_EQ(pi.integral(), 0.0) << dt;
  }
  pi.update(input(0.5, 1e9));  // counts as the longest step, no more
  EXPECT_NEAR(pi.integral(), 0.5 * PiController::kLongestStepS, 1e-12);
}

TEST(PiController, HoldsItsOutputOverAnErrorThatIsNotFinite) {
  PiController pi({.kp = 1.0, .ki = 1.0});
  for (int i = 0; i < 10; ++i) pi.update(input(0.5));
  const double integral = pi.integral();
  EXPECT_EQ(pi.update(input(std::numeric_limits<double>::quiet_NaN())), integral);
}

TEST(PiController, IntegralLimitShrinksTheIntegralAtOnce) {
  PiController pi({.kp = 0.0, .ki = 1.0});
  for (int i = 0; i < 80; ++i) pi.update(input(1.0));
  PiInput in = input(0.0);
  in.integral_limit = 0.1;
  EXPECT_EQ(pi.update(in), 0.1);
}

}  // namespace
}  // namespace rovigo::control
