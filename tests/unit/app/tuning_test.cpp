#include "app/tuning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/resources.h"

namespace rovigo::app {
namespace {

TrackSuite small_suite() {
  return parse_suite(
      "trajectories: {slalom: {shape: slalom, length_m: 2, wave_m: 2, curvature_1_m: 1}}\n"
      "groups: [{name: g, seeds: [1, 2], limits: {cross_track_rms_m: 0.05}}]\n",
      "small.yaml");
}

/// Ultimate gain and period of 1 / s * 1 / (lag s + 1) * exp(-delay s).
std::pair<double, double> ultimate_of(double lag_s, double delay_s) {
  double low = 1e-3, high = 1e3;
  for (int i = 0; i < 100; ++i) {
    const double w = (low + high) / 2;
    (std::atan(lag_s * w) + delay_s * w < std::numbers::pi / 2 ? low : high) = w;
  }
  return {low * std::hypot(1.0, lag_s * low), 2 * std::numbers::pi / low};
}

TEST(RelayOnRover, FindsWhatLagAndDelayOfTheRoverGiveInClosedForm) {
  for (const double latency : {0.05, 0.15}) {
    sim::Scenario scenario;  // the default one: noise and slips must not matter
    scenario.pose.latency_s = latency;
    const RelayTuning relay = relay_on_rover({}, scenario);
    ASSERT_TRUE(relay.ok());
    // On top of the poses' latency and mean jitter come their age between two poses, seen at
    // 120 Hz (1.5 steps in the mean), and half a step of a command.
    const double delay = latency + scenario.pose.jitter_s / 2 + 2.0 / 120;
    const auto [gain, period] = ultimate_of(scenario.motor.lag_s, delay);
    for (const auto& loop : {relay.heading, relay.speed}) {
      EXPECT_NEAR(loop.ultimate_gain, gain, 0.05 * gain) << latency;
      EXPECT_NEAR(loop.ultimate_period_s, period, 0.05 * period) << latency;
    }
  }
}

TEST(Tuning, SettingsAreRoundedToWhatAFileSaysAndStayInTheirRange) {
  const auto control = with_settings({}, {1.0 / 3.0, 1e9, 2.0, 0.5, 1.23456});
  EXPECT_EQ(control.heading_kp_1_s, 0.3333);
  EXPECT_EQ(control.heading_ki_1_s2, 20.0);
  EXPECT_EQ(control.cross_track_rate_1_s, 1.235);
  EXPECT_EQ(tuned_settings(control).size(), 5U);
  EXPECT_EQ(tuned_settings(control)[1].max, 20.0);
}

TEST(Tuning, ScoresAreTheSameForAnyNumberOfThreads) {
  const TrackBench bench(small_suite(), {}, std::nullopt);
  const auto cases = cases_of(bench.suite());
  control::ControlConfig other;
  other.heading_kp_1_s = 2.0;
  const auto one = score_settings(bench, cases, {{}, other}, 1, {});
  const auto three = score_settings(bench, cases, {{}, other}, 3, {});
  ASSERT_EQ(one.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(one[i].cost_mm, three[i].cost_mm);
    EXPECT_EQ(one[i].runs, 2U);
    EXPECT_EQ(one[i].failed, 0U);
  }
  EXPECT_NE(one[0].cost_mm, one[1].cost_mm);
}

TEST(Tuning, AFailedRunCostsMoreThanAnyErrorInOneThatPasses) {
  TrackSuite suite = small_suite();
  suite.groups[0].limits.cross_track_rms_m = 1e-6;
  const TrackBench bench(suite, {}, std::nullopt);
  const auto scores = score_settings(bench, cases_of(suite), {{}}, 2, {});
  EXPECT_EQ(scores[0].failed, 2U);
  EXPECT_GT(scores[0].cost_mm, 1000.0);
}

TEST(Tuning, TheSuiteOfTuneCanBeDriven) {
  const TrackSuite suite = load_suite(find_suite("tuning"));
  EXPECT_GE(cases_of(suite).size(), 10U);
  EXPECT_NO_THROW(TrackBench(suite, {}, std::nullopt));
}

}  // namespace
}  // namespace rovigo::app
