// The rover's physics against closed form.

#include "sim/rover.h"

#include <gtest/gtest.h>

#include <cmath>

#include "maps/error.h"
#include "test_worlds.h"

namespace rovigo::sim {
namespace {

struct Arc {
  double v;
  double w;
};

class CommandedArc : public testing::TestWithParam<Arc> {};

TEST_P(CommandedArc, IsFollowedWithinTwoPercent) {
  const auto [v, w] = GetParam();
  Simulator simulator(World(bare_floor()), blind_options());
  drive(simulator, {v, 0.0, w}, 1.0);  // up to speed
  const TPose2D start = true_pose(simulator);
  constexpr double kSeconds = 3.0;
  double turned = 0.0;
  double last = start.phi;
  for (int i = 0; i < static_cast<int>(kSeconds * 240); ++i) {
    simulator.step({v, 0.0, w});
    const double yaw = true_pose(simulator).phi;
    turned += maps::wrap_angle(yaw - last);
    last = yaw;
  }
  EXPECT_NEAR(turned, w * kSeconds, 0.02 * std::abs(w) * kSeconds + 0.002);
  // Where an exact unicycle would be, seen from the start.
  const double angle = w * kSeconds;
  const double radius = w == 0.0 ? 0.0 : v / w;
  const TPoint2D expected =
      w == 0.0 ? TPoint2D{v * kSeconds, 0.0}
               : TPoint2D{radius * std::sin(angle), radius * (1.0 - std::cos(angle))};
  const TPoint2D end = maps::position_of(maps::compose(maps::inverse(start), true_pose(simulator)));
  EXPECT_LT(maps::distance(end, expected), 0.03 * std::abs(v) * kSeconds + 0.005)
      << end.x << ", " << end.y << " instead of " << expected.x << ", " << expected.y;
}

INSTANTIATE_TEST_SUITE_P(Rover, CommandedArc,
                         testing::Values(Arc{0.4, 0.0}, Arc{0.1, 0.0}, Arc{-0.3, 0.0},
                                         Arc{0.3, 0.3}, Arc{0.4, -0.8}, Arc{-0.3, 0.2},
                                         Arc{0.0, 1.0}, Arc{0.0, -0.5}, Arc{0.4, 1.0},
                                         Arc{0.7, 0.2}));

TEST(Rover, StopsWithinCentimetresAndStays) {
  Simulator simulator(World(bare_floor()), blind_options());
  drive(simulator, {0.4, 0.0, 0.0}, 2.0);
  const TPose2D at_stop = true_pose(simulator);
  drive(simulator, {0.0, 0.0, 0.0}, 1.0);
  const TPose2D stopped = true_pose(simulator);
  EXPECT_LT(maps::distance(maps::position_of(at_stop), maps::position_of(stopped)), 0.04);
  drive(simulator, {0.0, 0.0, 0.0}, 5.0);
  EXPECT_LT(maps::distance(maps::position_of(stopped), maps::position_of(true_pose(simulator))),
            0.002)
      << "it creeps";
}

TEST(Rover, StandsStillBelowTheDeadZoneAndStartsAboveIt) {
  const double dead_zone = MotorModel{}.dead_zone_m_s;
  Simulator below(World(bare_floor()), blind_options());
  drive(below, {0.9 * dead_zone, 0.0, 0.0}, 2.0);
  EXPECT_LT(std::abs(true_pose(below).x), 0.002);
  Simulator above(World(bare_floor()), blind_options());
  drive(above, {1.1 * dead_zone, 0.0, 0.0}, 2.0);
  EXPECT_NEAR(true_pose(above).x, 1.1 * dead_zone * 2.0, 0.01);
}

TEST(Rover, KeepsRollingAtASpeedItCouldNotStartWith) {
  const double dead_zone = MotorModel{}.dead_zone_m_s;
  Simulator simulator(World(bare_floor()), blind_options());
  drive(simulator, {0.2, 0.0, 0.0}, 1.0);
  drive(simulator, {0.7 * dead_zone, 0.0, 0.0}, 1.0);
  EXPECT_NEAR(simulator.truth().twist.vx, 0.7 * dead_zone, 0.005);
}

TEST(Rover, NeverExceedsTheMotorsNoLoadSpeed) {
  Simulator simulator(World(bare_floor()), blind_options());
  drive(simulator, {5.0, 0.0, 0.0}, 6.0);
  EXPECT_LT(simulator.truth().twist.vx, 1.01 * maps::RobotModel{}.motor_no_load_speed_m_s);
  EXPECT_GT(simulator.truth().twist.vx, 0.8 * maps::RobotModel{}.motor_no_load_speed_m_s);
}

TEST(Rover, HittingAWallIsOneContactEventAndStopsIt) {
  Simulator simulator(World(wall_ahead(1.0)), blind_options());
  drive(simulator, {0.3, 0.0, 0.0}, 2.0);
  EXPECT_EQ(simulator.truth().contact_events, 0);
  drive(simulator, {0.3, 0.0, 0.0}, 3.0);
  EXPECT_EQ(simulator.truth().contact_events, 1);
  EXPECT_LT(true_pose(simulator).x, 1.0 - 0.2);
  drive(simulator, {-0.2, 0.0, 0.0}, 1.5);
  drive(simulator, {0.3, 0.0, 0.0}, 3.0);
  EXPECT_EQ(simulator.truth().contact_events, 2) << "the second run at it is a second event";
}

TEST(Rover, DrivesUnderADeskTopWithoutContact) {
  WorldModel model = bare_floor();
  model.solids.push_back(box_at(1.5, 0.0, 0.72, {0.7, 1.4, 0.03}));
  Simulator simulator((World(model)), blind_options());
  drive(simulator, {0.4, 0.0, 0.0}, 7.0);
  EXPECT_EQ(simulator.truth().contact_events, 0);
  EXPECT_GT(true_pose(simulator).x, 2.5);
}

TEST(Rover, RollsOverACarpetWithoutContact) {
  WorldModel model = bare_floor();
  model.solids.push_back(box_at(1.0, 0.0, 0.0, {1.0, 1.0, 0.006}));
  Simulator simulator((World(model)), blind_options());
  drive(simulator, {0.3, 0.0, 0.1}, 4.0);
  EXPECT_EQ(simulator.truth().contact_events, 0);
  EXPECT_GT(true_pose(simulator).x, 1.0);
}

TEST(Rover, AStartInsideAnObstacleIsRefusedAndTheObstacleNamed) {
  try {
    Simulator simulator(World(wall_ahead(0.1)), blind_options());
    FAIL() << "accepted";
  } catch (const maps::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("'box'"), std::string::npos) << e.what();
  }
}

TEST(Rover, AStartWithoutAFloorOrWithoutNumbersIsRefused) {
  SimulatorOptions beside = blind_options();
  beside.world_from_base = {100.0, 0.0, 0.0};
  EXPECT_THROW(Simulator(World(bare_floor()), beside), maps::InputError);
  SimulatorOptions nowhere = blind_options();
  nowhere.world_from_base = {std::nan(""), 0.0, 0.0};
  EXPECT_THROW(Simulator(World(bare_floor()), nowhere), maps::InputError);
  SimulatorOptions frozen = blind_options();
  frozen.camera_rate_hz = 0.0;
  EXPECT_THROW(Simulator(World(bare_floor()), frozen), maps::InputError);
}

TEST(Rover, NonFiniteCommandsAreTakenForZero) {
  Simulator simulator(World(bare_floor()), blind_options());
  drive(simulator, {std::nan(""), 0.0, 0.0}, 0.5);
  drive(simulator, {0.0, 0.0, INFINITY}, 0.5);
  EXPECT_LT(std::hypot(true_pose(simulator).x, true_pose(simulator).y), 0.002);
}

TEST(Rover, CommandsArriveAfterTheirLatency) {
  Scenario late = ideal_scenario();
  late.commands.latency_s = 0.3;
  Simulator simulator(World(bare_floor()), blind_options(late));
  drive(simulator, {0.4, 0.0, 0.0}, 0.28);
  EXPECT_LT(std::abs(true_pose(simulator).x), 0.002);
  drive(simulator, {0.4, 0.0, 0.0}, 0.5);
  EXPECT_GT(true_pose(simulator).x, 0.1);
}

TEST(Rover, ASlipTurnsTheRoverWhileItsWheelsSayStraight) {
  Scenario slippery = ideal_scenario();
  slippery.wheels.slip_events_per_minute = 30.0;
  Simulator simulator(World(bare_floor()), blind_options(slippery));
  drive(simulator, {0.4, 0.0, 0.0}, 20.0);
  const auto odometry = only<mrpt::obs::CObservationOdometry>(simulator.take_observations());
  EXPECT_NEAR(odometry.back()->odometry.phi(), 0.0, 0.02) << "the encoders see nothing";
  double drift = 0.0;
  drift = std::abs(true_pose(simulator).phi) + std::abs(true_pose(simulator).y);
  EXPECT_GT(drift, 0.05);
  EXPECT_LT(true_pose(simulator).x, odometry.back()->odometry.x() - 0.02);
}

TEST(Rover, AKidnapMovesItWithoutTheWheelsTurning) {
  Scenario kidnapped = ideal_scenario();
  kidnapped.kidnaps.push_back({.time_s = 1.0, .forward_m = 4.0, .left_m = 1.0, .turn_deg = 120.0});
  Simulator simulator(World(bare_floor()), blind_options(kidnapped));
  drive(simulator, {0.0, 0.0, 0.0}, 2.0);
  const TPose2D p = true_pose(simulator);
  EXPECT_NEAR(p.x, 4.0, 0.01);
  EXPECT_NEAR(p.y, 1.0, 0.01);
  EXPECT_NEAR(p.phi, 120.0 * maps::kPi / 180.0, 0.01);
  const auto all = simulator.take_observations();
  EXPECT_NEAR(only<mrpt::obs::CObservationOdometry>(all).back()->odometry.x(), 0.0, 0.005);
  for (const auto& imu : only<mrpt::obs::CObservationIMU>(all)) {
    EXPECT_NEAR(imu->get(mrpt::obs::IMU_Z_ACC), 9.81, 2.0) << "no jolt from being carried";
  }
}

}  // namespace
}  // namespace rovigo::sim
