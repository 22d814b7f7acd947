// For any gains, errors, limits and time steps, sane or not.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "control/pi_controller.h"

namespace rovigo::control {
namespace {

constexpr unsigned kSeed = 20261;

double hostile(std::mt19937_64& random) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  switch (random() % 12) {
    case 0:
      return std::numeric_limits<double>::quiet_NaN();
    case 1:
      return kInf;
    case 2:
      return -kInf;
    case 3:
      return 0.0;
    default:
      return std::uniform_real_distribution<double>(-5.0, 5.0)(random);
  }
}

TEST(PiProperty, OutputStaysWithinItsLimitsAndTheIntegralWithinIts) {
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> gain(0.0, 20.0), limit(0.01, 3.0);
  for (int run = 0; run < 300; ++run) {
    PiController pi({.kp = gain(random), .ki = gain(random), .anti_windup_time_s = limit(random)});
    for (int i = 0; i < 200; ++i) {
      PiInput in;
      in.error = hostile(random);
      in.dt_s = hostile(random);
      in.feed_forward = limit(random) - 1.5;
      in.max = limit(random);
      in.min = -limit(random);
      in.integral_limit = limit(random);
      const double out = pi.update(in);
      ASSERT_GE(out, in.min) << "seed " << kSeed << " run " << run << " step " << i;
      ASSERT_LE(out, in.max) << "seed " << kSeed << " run " << run << " step " << i;
      ASSERT_LE(std::abs(pi.integral()), in.integral_limit) << "seed " << kSeed << " run " << run;
    }
  }
}

TEST(PiProperty, TheIntegratorNeverGrowsAtSaturation) {
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> gain(0.1, 10.0), any(-2.0, 2.0);
  for (int run = 0; run < 500; ++run) {
    PiController pi({.kp = gain(random), .ki = gain(random)});
    for (int i = 0; i < 50; ++i) {
      pi.update({.error = any(random), .dt_s = 0.02, .min = -1, .max = 1, .integral_limit = 9});
    }
    for (int i = 0; i < 100; ++i) {
      const double error = any(random), before = pi.integral();
      const double kWide = 1e9;
      PiController twin = pi;
      const double free =
          twin.update({.error = error, .min = -kWide, .max = kWide, .integral_limit = 9});
      pi.update({.error = error, .dt_s = 0.02, .min = -1, .max = 1, .integral_limit = 9});
      if (std::abs(free) > 1.0 && free * error > 0.0) {
        ASSERT_LE(pi.integral() * std::copysign(1.0, free),
                  before * std::copysign(1.0, free) + 1e-12)
            << "seed " << kSeed << " run " << run;
      }
    }
  }
}

// The plant of mission F8: an integrator behind a first-order lag, under a constant push.
TEST(PiProperty, ASaturatedStepSettlesWithoutTheOvershootOfAWoundUpIntegrator) {
  const auto overshoot = [](auto&& law) {
    double x = 0.0, v = 0.0, most = 0.0;
    for (int i = 0; i < 6000; ++i) {
      const double u = law(1.0 - x);
      v += (u - 1.2775 * v) * 0.01;
      x += v * 0.01;
      most = std::max(most, x - 1.0);
    }
    return most;
  };
  PiController ours({.kp = 0.9, .ki = 0.3, .anti_windup_time_s = 0.2});
  double wound = 0.0;
  const double with = overshoot([&](double e) {
    return ours.update({.error = e, .dt_s = 0.01, .min = -0.2, .max = 0.2, .integral_limit = 10});
  });
  const double without = overshoot([&](double e) {
    wound += 0.3 * e * 0.01;
    return std::clamp(0.9 * e + wound, -0.2, 0.2);
  });
  EXPECT_LT(with, 0.6 * without);
}

}  // namespace
}  // namespace rovigo::control
