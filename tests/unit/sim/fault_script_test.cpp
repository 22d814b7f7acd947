#include "sim/fault_script.h"

#include <gtest/gtest.h>

#include "test_worlds.h"

namespace rovigo::sim {
namespace {

TEST(FaultScript, AFaultRulesFromItsStartForItsDuration) {
  const FaultScript script({{.kind = "poses_stall", .start_s = 2.0, .duration_s = 1.0}}, 1);
  EXPECT_EQ(script.active(FaultKind::kPosesStall, 1.99), nullptr);
  EXPECT_NE(script.active(FaultKind::kPosesStall, 2.0), nullptr);
  EXPECT_NE(script.active(FaultKind::kPosesStall, 2.99), nullptr);
  EXPECT_EQ(script.active(FaultKind::kPosesStall, 3.0), nullptr);
  EXPECT_EQ(script.active(FaultKind::kPosesLate, 2.5), nullptr) << "another kind";
}

TEST(FaultScript, WithoutADurationItIsForGood) {
  const FaultScript script({{.kind = "manual_takeover", .start_s = 2.0}}, 1);
  EXPECT_NE(script.active(FaultKind::kManualTakeover, 1e5), nullptr);
}

TEST(FaultScript, TheSeedDrawsWhenItBeginsWithinTheSpanGiven) {
  double earliest = 1e9, latest = 0.0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Fault fault{.kind = "set_points_stop", .start_s = 2.0, .within_s = 3.0};
    const FaultScript script({fault}, seed);
    const FaultScript same({fault}, seed);
    double t = 0.0;
    while (!script.active(FaultKind::kSetPointsStop, t)) t += 0.01;
    EXPECT_NE(same.active(FaultKind::kSetPointsStop, t), nullptr);
    EXPECT_GE(t, 2.0 - 0.011);
    EXPECT_LE(t, 5.0 + 0.011);
    earliest = std::min(earliest, t);
    latest = std::max(latest, t);
  }
  EXPECT_LT(earliest, 2.5);
  EXPECT_GT(latest, 4.5);
}

TEST(FaultScript, TheVoltmeterShowsALowBatteryWhileItIsLow) {
  Scenario s = ideal_scenario();
  s.faults.push_back(
      {.kind = "battery_low", .start_s = 1.0, .duration_s = 1.0, .voltage_share = 0.8});
  Simulator simulator(World(bare_floor()), blind_options(s));
  const double nominal = maps::RobotModel{}.battery_nominal_v;
  EXPECT_NEAR(simulator.battery_v(), nominal, 1e-12);
  drive(simulator, {}, 1.5);
  EXPECT_NEAR(simulator.battery_v(), 0.8 * nominal, 1e-12);
  drive(simulator, {}, 1.0);
  EXPECT_NEAR(simulator.battery_v(), nominal, 1e-12);
}

}  // namespace
}  // namespace rovigo::sim
