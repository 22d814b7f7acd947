#include "sim/command_link.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace rovigo::sim {
namespace {

constexpr double kStepS = 1.0 / 240;

/// The speed received at each step when the speed sent is the time itself.
std::vector<double> received_by(const CommandLinkModel& model, int steps, std::uint64_t seed = 3) {
  CommandLink link(model, seed);
  std::vector<double> out;
  for (int i = 0; i < steps; ++i) out.push_back(link.pass(i * kStepS, {i * kStepS, 0.0, 0.0}).vx);
  return out;
}

TEST(CommandLink, AFreshLinkHandsOnEveryPacketAtOnce) {
  const auto got = received_by({.rate_hz = 120}, 240);
  for (int i = 0; i < 240; ++i) EXPECT_NEAR(got[i], (i - i % 2) * kStepS, 1e-12) << i;
}

TEST(CommandLink, LatencyShiftsInTimeAndNothingIsCommandedBefore) {
  const auto got = received_by({.rate_hz = 240, .latency_s = 0.1}, 480);
  for (int i = 0; i < 24; ++i) EXPECT_EQ(got[i], 0.0);
  for (int i = 24; i < 480; ++i) EXPECT_NEAR(got[i], (i - 24) * kStepS, 1e-9);
}

TEST(CommandLink, JitterSpreadsTheAgeEvenlyAboutTheLatencyAndKeepsTheOrder) {
  const auto got = received_by({.rate_hz = 20, .latency_s = 0.1, .jitter_s = 0.02}, 240 * 100);
  EXPECT_TRUE(std::is_sorted(got.begin(), got.end()));
  double sum = 0.0, least = 1.0, most = 0.0;
  int count = 0;
  for (std::size_t i = 1; i < got.size(); ++i) {
    if (got[i] == got[i - 1]) continue;
    const double age = static_cast<double>(i) * kStepS - got[i];
    sum += age;
    least = std::min(least, age);
    most = std::max(most, age);
    ++count;
  }
  EXPECT_GE(least, 0.08 - 1e-9);
  EXPECT_LE(most, 0.12 + kStepS);                     // seen at the next step
  EXPECT_NEAR(sum / count, 0.1 + kStepS / 2, 0.001);  // sigma of the mean: 0.0003
}

TEST(CommandLink, TheShareAskedForIsLostAndTheLastCommandHolds) {
  const auto got = received_by({.rate_hz = 120, .drop_share = 0.1}, 240 * 60);
  int changes = 0;
  for (std::size_t i = 1; i < got.size(); ++i) changes += got[i] != got[i - 1] ? 1 : 0;
  EXPECT_NEAR(changes / (120.0 * 60.0), 0.9, 0.012);  // sigma: 0.0035
  EXPECT_EQ(got, received_by({.rate_hz = 120, .drop_share = 0.1}, 240 * 60)) << "same seed";
  EXPECT_NE(got, received_by({.rate_hz = 120, .drop_share = 0.1}, 240 * 60, 4));
}

TEST(CommandLink, WhatIsNotFiniteIsStandstill) {
  CommandLink link({}, 1);
  EXPECT_EQ(link.pass(0.0, {0.3, 0.0, 0.1}).vx, 0.3);
  const TTwist2D got = link.pass(1.0, {std::nan(""), 0.0, 0.1});
  EXPECT_EQ(got.vx, 0.0);
  EXPECT_EQ(got.omega, 0.0);
}

}  // namespace
}  // namespace rovigo::sim
