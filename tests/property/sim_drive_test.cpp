// Driving in whole worlds: a rover steered along a shipped route, or about a random office, on its
// true pose touches nothing, and what its sensors say stays consistent with where it went.

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>

#include "sim/route.h"
#include "sim/simulator.h"

namespace rovigo::sim {
namespace {

const std::string kSim = ROVIGO_SOURCE_DIR "/sim/";

TPose2D true_pose(const Simulator& simulator) {
  const auto& p = simulator.truth().world_from_base;
  return {p.x(), p.y(), p.yaw()};
}

/// Turns towards the goal, then drives at it; the plainest steering there is.
TTwist2D steer(const TPose2D& pose, const TPoint2D& goal, double speed_m_s) {
  const double bearing = std::atan2(goal.y - pose.y, goal.x - pose.x);
  const double error = maps::wrap_angle(bearing - pose.phi);
  const double turn = std::clamp(2.0 * error, -1.0, 1.0);
  return {std::abs(error) > 0.3 ? 0.0 : speed_m_s, 0.0, turn};
}

class DrivenRoute : public testing::TestWithParam<std::string> {};

TEST_P(DrivenRoute, TouchesNothing) {
  const Route route = load_route(kSim + "routes/" + GetParam() + ".yaml");
  const World world = World::load(kSim + "worlds/" + route.world + ".sdf");
  SimulatorOptions options;
  options.world_from_base = world.start();
  options.camera_enabled = false;
  Simulator simulator(world, options);
  double yaw_from_gyro = options.world_from_base.phi;
  for (const TPoint2D& goal : route.waypoints) {
    while (maps::distance(maps::position_of(true_pose(simulator)), goal) > 0.05) {
      ASSERT_LT(simulator.time_s(), 600.0) << "stuck on the way to " << goal.x << ", " << goal.y;
      simulator.step(steer(true_pose(simulator), goal, route.speed_m_s));
      for (const auto& o : simulator.take_observations()) {
        if (const auto imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(o)) {
          yaw_from_gyro += imu->get(mrpt::obs::IMU_WZ) / options.scenario.imu.rate_hz;
        }
      }
    }
  }
  EXPECT_EQ(simulator.truth().contact_events, 0);
  // A bias of at most 0.01 rad/s is all that separates the gyro's heading from the true one.
  const double seconds = simulator.time_s() - 1.0;
  EXPECT_LT(std::abs(maps::wrap_angle(yaw_from_gyro - true_pose(simulator).phi)),
            0.011 * seconds + 0.05);
  RecordProperty("seconds", std::to_string(seconds));
}

INSTANTIATE_TEST_SUITE_P(Shipped, DrivenRoute,
                         testing::Values("lab_tour", "lab_short", "corridor_out_and_back"),
                         [](const auto& test) { return test.param; });

TEST(RandomOfficeDrive, ABlindRoverBumpsIntoThingsAndStaysInside) {
  // Straight ahead until something is touched, back off, turn: contacts are counted, walls hold.
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const World world = World::random_office(seed);
    SimulatorOptions options;
    options.world_from_base = world.start();
    options.camera_enabled = false;
    options.seed = seed;
    Simulator simulator(world, options);
    const auto grid = true_grid(world, 0.05, 0.05, 0.50);
    int contacts = 0;
    int backing = 0;
    for (int i = 0; i < 240 * 60; ++i) {
      if (simulator.truth().contact_events > contacts) {
        contacts = simulator.truth().contact_events;
        backing = 480;
      }
      simulator.step(backing > 240 ? TTwist2D(-0.2, 0.0, 0.0)
                     : backing > 0 ? TTwist2D(0.0, 0.0, 1.1)
                                   : TTwist2D(0.4, 0.0, 0.0));
      backing = std::max(0, backing - 1);
      if (i % 24 != 0) continue;
      const TPose2D p = true_pose(simulator);
      const maps::Cell c = grid.geometry.cell_at(maps::position_of(p));
      ASSERT_TRUE(grid.geometry.contains(c)) << "seed " << seed;
      ASSERT_TRUE(maps::OccupancyGrid::is_free(grid.at(c))) << "seed " << seed << " inside a wall";
      ASSERT_LT(std::abs(simulator.truth().world_from_base.z()), 0.05) << "left the floor";
    }
    EXPECT_GT(contacts, 1) << "seed " << seed;
  }
}

}  // namespace
}  // namespace rovigo::sim
