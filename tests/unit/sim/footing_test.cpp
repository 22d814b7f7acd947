#include "sim/footing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "sim/tires.h"

namespace rovigo::sim {
namespace {

const maps::RobotModel kRobot;

TEST(Footing, WheelsTogetherCarryEverythingAndBalanceIt) {
  const Payload payload{.mass_kg = 3.0, .forward_m = 0.05, .left_m = -0.08, .up_m = 0.2};
  const auto n = wheel_loads(kRobot, payload);
  EXPECT_NEAR(std::accumulate(n.begin(), n.end(), 0.0), 9.5 * kGravityMS2, 1e-9);
  // No torque about the middle is left over.
  const double pitch = (n[0] + n[1] - n[2] - n[3]) * kRobot.wheel_base_m / 2;
  const double roll = (n[0] + n[2] - n[1] - n[3]) * kRobot.track_width_m / 2;
  EXPECT_NEAR(pitch, 3.0 * kGravityMS2 * 0.05, 1e-9);
  EXPECT_NEAR(roll, 3.0 * kGravityMS2 * -0.08, 1e-9);
  for (const double even : wheel_loads(kRobot, {})) {
    EXPECT_NEAR(even, 6.5 * kGravityMS2 / 4, 1e-9);
  }
}

TEST(Footing, AWheelThatWouldLiftOffCarriesNothing) {
  const auto n = wheel_loads(kRobot, {.mass_kg = 50.0, .forward_m = 0.5, .left_m = 0.0});
  EXPECT_EQ(n[2], 0.0);
  EXPECT_EQ(n[3], 0.0);
}

TEST(Footing, TheCentreOfMassMovesTowardsTheLoad) {
  const MassProperties empty = loaded_body(kRobot, {});
  EXPECT_NEAR(empty.mass_kg, 6.5 - 4 * 0.3, 1e-12);
  EXPECT_EQ(empty.center_of_mass, Eigen::Vector3d(0, 0, kRobot.center_of_mass_height_m));
  const MassProperties loaded =
      loaded_body(kRobot, {.mass_kg = 5.3, .forward_m = 0.1, .left_m = 0.04, .up_m = 0.29});
  EXPECT_NEAR(loaded.center_of_mass.x(), 0.05, 1e-12);
  EXPECT_NEAR(loaded.center_of_mass.y(), 0.02, 1e-12);
  EXPECT_NEAR(loaded.center_of_mass.z(), 0.19, 1e-12);
  // Two equal masses 2 d apart: each m d^2, about the vertical.
  const double apart = 2 * 5.3 * (0.05 * 0.05 + 0.02 * 0.02);
  EXPECT_NEAR(loaded.inertia.z(), empty.inertia.z() + apart, 1e-9);
}

TEST(Footing, GravityPullsDownhillAndKeepsItsStrength) {
  const Eigen::Vector3d g = gravity_on({.angle_deg = 5.0, .uphill_deg = 90.0});
  EXPECT_NEAR(g.norm(), kGravityMS2, 1e-12);
  EXPECT_NEAR(g.x(), 0.0, 1e-12);
  EXPECT_NEAR(g.y(), -kGravityMS2 * std::sin(5.0 * maps::kPi / 180.0), 1e-12);
  EXPECT_EQ(gravity_on({}), Eigen::Vector3d(-0.0, -0.0, -kGravityMS2));
}

TEST(Footing, PatchesCoverTheShareOfTheFloorAskedFor) {
  const FloorGrip grip{.slippery_share = 0.3, .patch_m = 0.4, .slippery_grip = 0.25};
  int slippery = 0;
  constexpr int kSide = 100;
  for (int i = 0; i < kSide; ++i) {
    for (int k = 0; k < kSide; ++k) {
      const double g = grip_at(grip, 7, {0.4 * (i - 50) + 0.2, 0.4 * (k - 50) + 0.2});
      ASSERT_TRUE(g == 1.0 || g == 0.25);
      slippery += g < 1.0 ? 1 : 0;
    }
  }
  // 10000 draws: sigma 0.0046.
  EXPECT_NEAR(slippery / double(kSide * kSide), 0.3, 0.015);
  EXPECT_EQ(grip_at({}, 7, {1.0, 1.0}), 1.0);
}

TEST(TireSide, ScrubsInProportionUpToItsFrictionAndHoldsWhenParked) {
  TireSide rolling(kRobot);
  constexpr double kDt = 1.0 / 240;
  EXPECT_NEAR(rolling.force(0.01, true, 16.0, 1.0, kDt), -kRobot.tire_scrub_n_s_m * 0.01, 1e-12);
  EXPECT_NEAR(rolling.force(5.0, true, 16.0, 1.0, kDt), -kRobot.tire_side_friction * 16.0, 1e-12);
  EXPECT_NEAR(rolling.force(5.0, true, 16.0, 0.5, kDt), -kRobot.tire_side_friction * 8.0, 1e-12);
  TireSide parked(kRobot);
  parked.force(0.01, false, 16.0, 1.0, kDt);
  EXPECT_LT(parked.force(0.0, false, 16.0, 1.0, kDt), -0.1) << "it remembers where it stood";
  parked.force(0.0, true, 16.0, 1.0, kDt);
  EXPECT_EQ(parked.force(0.0, false, 16.0, 1.0, kDt), 0.0) << "rolling lets go";
}

}  // namespace
}  // namespace rovigo::sim
