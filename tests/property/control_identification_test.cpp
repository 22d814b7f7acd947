// Random models, logs and noise: the model is found, and its confidence is honest.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/identification.h"

namespace rovigo::control {
namespace {

constexpr unsigned kSeed = 20265;

bool holds(const ConfidenceInterval& interval, double value) {
  return interval.low <= value && value <= interval.high;
}

TEST(IdentificationProperty, RecoversRandomModelsFromNoisyUnevenLogsWithHonestConfidence) {
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> normal;
  constexpr int kRuns = 60;
  int gain_held = 0, time_constant_held = 0, dead_time_held = 0;
  double gain_half_width = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const FirstOrderModel truth{(unit(random) < 0.2 ? -1.0 : 1.0) * (0.2 + 2.0 * unit(random)),
                                0.05 * std::pow(30.0, unit(random)), 0.4 * unit(random)};
    std::vector<IdentificationSample> log;
    double level = 0.0, t = 100.0 * unit(random), hold_until = t;
    for (int i = 0; i < 1500; ++i) {
      if (t >= hold_until) {
        level = 2.0 * unit(random) - 1.0;
        hold_until = t + 0.3 + 3.0 * unit(random);
      }
      log.push_back({t, level, 0.0});
      t += 0.01 + 0.02 * unit(random);
    }
    const auto y = simulate(truth, log, truth.gain * 0.3);
    const double noise = 0.05 * std::abs(truth.gain);
    for (std::size_t i = 0; i < log.size(); ++i) log[i].response = y[i] + noise * normal(random);
    const IdentificationResult r = identify_first_order(log);
    ASSERT_EQ(r.status, IdentificationStatus::kOk) << "seed " << kSeed << " run " << run;
    EXPECT_NEAR(r.model.gain, truth.gain, 0.05 * std::abs(truth.gain)) << "run " << run;
    EXPECT_NEAR(r.model.time_constant_s, truth.time_constant_s, 0.01 + 0.1 * truth.time_constant_s)
        << "run " << run;
    EXPECT_NEAR(r.model.dead_time_s, truth.dead_time_s, 0.01 + 0.05 * truth.time_constant_s)
        << "run " << run;
    gain_half_width += (r.gain_95.high - r.gain_95.low) / 2.0 / std::abs(truth.gain);
    gain_held += holds(r.gain_95, truth.gain);
    time_constant_held += holds(r.time_constant_95_s, truth.time_constant_s);
    dead_time_held += holds(r.dead_time_95_s, truth.dead_time_s);
  }
  // 95 % of 60 is 57; three standard deviations of such a count are 5.
  EXPECT_GE(gain_held, 52);
  EXPECT_GE(time_constant_held, 52);
  EXPECT_GE(dead_time_held, 52);
  EXPECT_LT(gain_half_width / kRuns, 0.02) << "of the gain: honest, but not by being vague";
}

}  // namespace
}  // namespace rovigo::control
