#include "control/identification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rovigo::control {
namespace {

using Log = std::vector<IdentificationSample>;

/// Steps of the set-point every second, 50 Hz, 20 s.
Log stepped_log() {
  Log log;
  const double levels[] = {0.0, 0.3, 0.1, 0.4, -0.2, 0.2, 0.0};
  for (int i = 0; i < 1000; ++i) log.push_back({i * 0.02, levels[i / 50 % 7], 0.0});
  return log;
}

Log responding(Log log, const FirstOrderModel& model, double noise = 0.0) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const auto y = simulate(model, log, 0.0);
  for (std::size_t i = 0; i < log.size(); ++i) log[i].response = y[i] + noise * normal(random);
  return log;
}

TEST(Identification, SimulatesTheClosedFormStepResponse) {
  const Log log{{0.0, 0.0, 0.0}, {1.0, 2.0, 0.0}, {1.5, 2.0, 0.0}, {1.7, 2.0, 0.0}, {3.7, 2.0, 0}};
  const auto y = simulate({1.5, 0.4, 0.6}, log, 0.5);
  EXPECT_NEAR(y[0], 0.5, 1e-12);
  EXPECT_NEAR(y[1], 0.5 * std::exp(-1.0 / 0.4), 1e-12);
  EXPECT_NEAR(y[2], 0.5 * std::exp(-1.5 / 0.4), 1e-12);
  const auto after = [](double t) {
    return 3.0 * (1.0 - std::exp(-(t - 1.6) / 0.4)) + 0.5 * std::exp(-t / 0.4);
  };
  EXPECT_NEAR(y[3], after(1.7), 1e-12);
  EXPECT_NEAR(y[4], after(3.7), 1e-12);
}

TEST(Identification, FindsTheModelExactlyWhereThereIsNoNoise) {
  const auto r = identify_first_order(responding(stepped_log(), {0.9, 0.35, 0.07}));
  ASSERT_EQ(r.status, IdentificationStatus::kOk);
  EXPECT_NEAR(r.model.gain, 0.9, 1e-6);
  EXPECT_NEAR(r.model.time_constant_s, 0.35, 1e-5);
  EXPECT_NEAR(r.model.dead_time_s, 0.07, 1e-5);
  EXPECT_NEAR(r.fit_share, 1.0, 1e-5);
  EXPECT_NEAR(r.validation_fit_share, 1.0, 1e-4);
}

TEST(Identification, FindsTheThesissTwoAxesAgain) {
  for (const double pole : {1.2775, 1.4350}) {  // 1 / (s + pole)
    Log log;
    for (int i = 0; i < 6000; ++i) log.push_back({i * 0.01, (i / 400) % 2 ? 0.5 : -0.3, 0.0});
    const auto r = identify_first_order(responding(log, {1.0 / pole, 1.0 / pole, 0.0}, 0.03));
    ASSERT_EQ(r.status, IdentificationStatus::kOk);
    EXPECT_NEAR(1.0 / r.model.time_constant_s, pole, 0.03 * pole);
    EXPECT_NEAR(r.model.gain / r.model.time_constant_s, 1.0, 0.03);
    EXPECT_LT(r.model.dead_time_s, 0.03);
  }
}

TEST(Identification, IsNotPulledByOutliersOrHolesInTheLog) {
  Log log = responding(stepped_log(), {1.1, 0.2, 0.1}, 0.005);
  std::mt19937_64 random(3);
  for (auto& s : log) {
    if (random() % 20 == 0) s.response += 1.0;         // a slipping wheel, a wrong fix
    if (random() % 3 == 0) s.response = std::nan("");  // not measured in this row
  }
  log.erase(log.begin() + 300, log.begin() + 330);
  log[500].time_s = log[400].time_s;  // out of order
  const auto r = identify_first_order(log);
  ASSERT_EQ(r.status, IdentificationStatus::kOk);
  EXPECT_NEAR(r.model.gain, 1.1, 0.02);
  EXPECT_NEAR(r.model.time_constant_s, 0.2, 0.02);
  EXPECT_NEAR(r.model.dead_time_s, 0.1, 0.02);
}

TEST(Identification, RefusesALogWithoutExcitation) {
  Log log = stepped_log();
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (auto& s : log) s = {s.time_s, 0.3, 0.3 + 0.01 * normal(random)};
  EXPECT_EQ(identify_first_order(log).status, IdentificationStatus::kNoExcitation);
}

TEST(Identification, RefusesAResponseThatDoesNotFollow) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Log log = stepped_log();
  for (auto& s : log) s.response = normal(random);
  EXPECT_EQ(identify_first_order(log).status, IdentificationStatus::kNoResponse);
  for (auto& s : log) s.response = 0.0;  // a rover that stands
  EXPECT_EQ(identify_first_order(log).status, IdentificationStatus::kNoResponse);
}

TEST(Identification, RefusesTooFewSamplesAndNonsense) {
  EXPECT_EQ(identify_first_order({}).status, IdentificationStatus::kTooFewSamples);
  Log log = stepped_log();
  log.resize(15);
  EXPECT_EQ(identify_first_order(log).status, IdentificationStatus::kTooFewSamples);
  log = stepped_log();
  for (auto& s : log) s.time_s = std::nan("");
  EXPECT_EQ(identify_first_order(log).status, IdentificationStatus::kTooFewSamples);
}

TEST(Identification, SaysThatAnOscillationIsNotOfFirstOrder) {
  Log log = stepped_log();
  double y = 0.0, v = 0.0;
  for (auto& s : log) {  // natural frequency 6 rad/s, damping 0.03
    s.response = y;
    for (int i = 0; i < 20; ++i) {
      v += 0.001 * (36.0 * (s.setpoint - y) - 2.0 * 0.03 * 6.0 * v);
      y += 0.001 * v;
    }
  }
  EXPECT_EQ(identify_first_order(log).status, IdentificationStatus::kNotFirstOrder);
}

}  // namespace
}  // namespace rovigo::control
