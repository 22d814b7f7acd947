#include "control/relay_experiment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <deque>
#include <memory>
#include <numbers>
#include <random>

namespace rovigo::control {
namespace {

constexpr double kStepS = 0.002;

/// Two lags in series behind a dead time; the first may be an integrator instead.
struct Model {
  double gain = 1.0;
  double first_lag_s = 0.5;
  double second_lag_s = 0.1;
  double dead_time_s = 0.1;
  bool integrating = false;
};

std::complex<double> response(const Model& m, double w) {
  const std::complex<double> s(0.0, w);
  const auto first = m.integrating ? 1.0 / s : 1.0 / (1.0 + m.first_lag_s * s);
  return m.gain * first / (1.0 + m.second_lag_s * s) * std::exp(-s * m.dead_time_s);
}

/// Closed form: the phase falls steadily, so the frequency of phase -pi is found by halving.
struct Ultimate {
  double gain = 0.0;
  double period_s = 0.0;
};
Ultimate ultimate_of(const Model& m) {
  const auto phase = [&m](double w) {
    const double first = m.integrating ? std::numbers::pi / 2 : std::atan(m.first_lag_s * w);
    return first + std::atan(m.second_lag_s * w) + m.dead_time_s * w;
  };
  double low = 1e-6, high = 1e4;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (phase(middle) < std::numbers::pi ? low : high) = middle;
  }
  return {1.0 / std::abs(response(m, low)), 2 * std::numbers::pi / low};
}

/// Exact for inputs that hold over a step; optional noise on the output.
Plant plant_of(const Model& m, double noise = 0.0) {
  struct State {
    double first = 0.0, second = 0.0;
    std::deque<double> under_way;
    std::mt19937_64 random{1};
  };
  auto state = std::make_shared<State>();
  // Half a step of the hold and the step until the relay sees it are dead time, too.
  const auto delay = static_cast<std::size_t>(std::lround(m.dead_time_s / kStepS));
  state->under_way.assign(delay > 1 ? delay - 1 : 0, 0.0);
  return [m, noise, state](double input) {
    state->under_way.push_back(input);
    const double u = state->under_way.front();
    state->under_way.pop_front();
    constexpr int kFine = 20;
    for (int i = 0; i < kFine; ++i) {
      const double h = kStepS / kFine;
      state->first +=
          m.integrating ? h * m.gain * u : h / m.first_lag_s * (m.gain * u - state->first);
      state->second += h / m.second_lag_s * (state->first - state->second);
    }
    return state->second + noise * std::normal_distribution<double>()(state->random);
  };
}

TEST(RelayExperiment, FindsTheUltimateGainAndPeriodOfTheClosedForm) {
  const Model models[] = {{1.0, 0.5, 0.1, 0.1, false},
                          {2.5, 1.0, 1.0, 0.3, false},
                          {0.8, 0.5, 0.04, 0.1, true},
                          {1.0, 0.2, 0.05, 0.4, false},
                          {5.0, 3.0, 0.2, 0.05, false}};
  for (const Model& m : models) {
    const auto r = relay_experiment([&m] { return plant_of(m); }, {.step_s = kStepS});
    ASSERT_EQ(r.status, RelayStatus::kOk);
    const Ultimate truth = ultimate_of(m);
    EXPECT_NEAR(r.ultimate_gain, truth.gain, 0.03 * truth.gain) << m.dead_time_s;
    EXPECT_NEAR(r.ultimate_period_s, truth.period_s, 0.03 * truth.period_s) << m.dead_time_s;
  }
}

TEST(RelayExperiment, DoesNotDependOnTheRelaysAmplitude) {
  const Model m;
  const auto a = relay_experiment([&m] { return plant_of(m); }, {.step_s = kStepS});
  const auto b =
      relay_experiment([&m] { return plant_of(m); }, {.step_s = kStepS, .amplitude = 0.01});
  EXPECT_NEAR(a.ultimate_gain, b.ultimate_gain, 1e-6 * a.ultimate_gain);
  EXPECT_NEAR(b.output_amplitude, 0.01 * a.output_amplitude, 1e-9);
}

TEST(RelayExperiment, BearsNoiseBelowItsHysteresis) {
  const Model m;
  const auto r =
      relay_experiment([&m] { return plant_of(m, 0.01); }, {.step_s = kStepS, .hysteresis = 0.06});
  ASSERT_EQ(r.status, RelayStatus::kOk);
  const Ultimate truth = ultimate_of(m);
  EXPECT_NEAR(r.ultimate_gain, truth.gain, 0.1 * truth.gain);
  EXPECT_NEAR(r.ultimate_period_s, truth.period_s, 0.1 * truth.period_s);
}

TEST(RelayExperiment, SaysSoWhenNothingOscillates) {
  const auto dead = [] { return Plant([](double) { return 0.5; }); };
  EXPECT_EQ(relay_experiment(dead, {}).status, RelayStatus::kNoOscillation);
  const auto broken = [] { return Plant([](double) { return std::nan(""); }); };
  EXPECT_EQ(relay_experiment(broken, {}).status, RelayStatus::kNoOscillation);
}

TEST(RelayExperiment, SaysSoWhenTheOscillationIsUneven) {
  const auto random = [] {
    auto generator = std::make_shared<std::mt19937_64>(5);
    return Plant([generator](double) { return std::normal_distribution<double>()(*generator); });
  };
  EXPECT_EQ(relay_experiment(random, {}).status, RelayStatus::kUneven);
}

TEST(ZieglerNichols, IsTheThesissTable) {
  const PidGains p = ziegler_nichols(ZieglerNicholsRow::kP, 6.0, 2.0);
  EXPECT_DOUBLE_EQ(p.kp, 3.0);
  EXPECT_EQ(p.ki, 0.0);
  const PidGains pi = ziegler_nichols(ZieglerNicholsRow::kPi, 6.6, 2.4);
  EXPECT_DOUBLE_EQ(pi.kp, 3.0);
  EXPECT_DOUBLE_EQ(pi.ki, 1.5);
  const PidGains pid = ziegler_nichols(ZieglerNicholsRow::kPid, 5.1, 2.0);
  EXPECT_DOUBLE_EQ(pid.kp, 3.0);
  EXPECT_DOUBLE_EQ(pid.ki, 3.0);
  EXPECT_DOUBLE_EQ(pid.kd, 0.75);
}

}  // namespace
}  // namespace rovigo::control
