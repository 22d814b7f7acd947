#include "sim/kidnapping.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test_worlds.h"

namespace rovigo::sim {
namespace {

constexpr double kDeg = maps::kPi / 180.0;

Scenario with_kidnap(const Kidnap& kidnap) {
  Scenario scenario = ideal_scenario();
  scenario.kidnaps.push_back(kidnap);
  return scenario;
}

/// A rover on a bare floor that is carried away after 1 s and looked at until 5 s.
struct Observed {
  std::vector<mrpt::obs::CObservation::Ptr> all;
  TPose2D before;
  TPose2D after;
};
Observed carried(const Kidnap& kidnap, double rate_hz = 10.0) {
  SimulatorOptions options;
  options.scenario = with_kidnap(kidnap);
  options.camera_rate_hz = rate_hz;
  Simulator simulator(World(bare_floor()), options);
  Observed out;
  drive(simulator, {0.3, 0.0, 0.0}, 1.0 - Simulator::kStepS);
  out.before = true_pose(simulator);
  drive(simulator, {0.3, 0.0, 0.0}, kidnap.carry_s);
  EXPECT_EQ(simulator.truth().kidnaps, 1);
  drive(simulator, {}, 2.0);
  EXPECT_FALSE(simulator.truth().carried);
  out.after = true_pose(simulator);
  out.all = simulator.take_observations();
  return out;
}

template <class Kind>
int count_between(const std::vector<mrpt::obs::CObservation::Ptr>& all, double from_s,
                  double to_s) {
  int n = 0;
  for (const auto& o : only<Kind>(all)) {
    const double t = mrpt::Clock::toDouble(o->timestamp);
    n += t > from_s && t < to_s;
  }
  return n;
}

double turned_by_gyro(const std::vector<mrpt::obs::CObservation::Ptr>& all) {
  double sum = 0.0;
  for (const auto& o : only<mrpt::obs::CObservationIMU>(all)) {
    sum += o->get(mrpt::obs::IMU_WZ) / 100.0;
  }
  return sum;
}

Kidnap ride(const std::string& kind) {
  Kidnap kidnap;
  kidnap.time_s = 1.0;
  kidnap.carry_s = 2.0;
  kidnap.kind = kind;
  return kidnap;
}

TEST(Kidnap, EndsAsFarAwayAndAsFarTurnedAsAskedWithTheWheelsStill) {
  const Observed o = carried(ride("carried"));
  EXPECT_NEAR(maps::distance(maps::position_of(o.before), maps::position_of(o.after)), 4.0, 0.02);
  EXPECT_NEAR(maps::wrap_angle(o.after.phi - o.before.phi), 120.0 * kDeg, 0.02);
  const auto wheels = only<mrpt::obs::CObservationOdometry>(o.all);
  EXPECT_NEAR(wheels.back()->odometry.x(), o.before.x, 0.02) << "they did not feel the ride";
  EXPECT_NEAR(wheels.back()->odometry.phi(), 0.0, 0.01);
}

TEST(Kidnap, NoFrameComesWhileItIsCarriedOrBlackOnesDo) {
  EXPECT_EQ(
      count_between<mrpt::obs::CObservation3DRangeScan>(carried(ride("carried")).all, 2.05, 3.95),
      0);
  Kidnap covered = ride("carried");
  covered.camera = "covered";
  const Observed o = carried(covered);
  EXPECT_EQ(count_between<mrpt::obs::CObservation3DRangeScan>(o.all, 2.05, 3.95), 19);
  for (const auto& frame : only<mrpt::obs::CObservation3DRangeScan>(o.all)) {
    const double t = mrpt::Clock::toDouble(frame->timestamp);
    if (t < 2.05 || t > 3.95) continue;
    EXPECT_EQ(frame->rangeImage.maxCoeff(), 0);
  }
}

TEST(Kidnap, TheImuFeelsTheRideUnlessItIsUnfeltOrSwitchedOff) {
  const Observed felt = carried(ride("carried"));
  EXPECT_NEAR(turned_by_gyro(felt.all), 120.0 * kDeg, 0.05);
  double lift = 0.0;
  for (const auto& o : only<mrpt::obs::CObservationIMU>(felt.all)) {
    const double t = mrpt::Clock::toDouble(o->timestamp);
    if (t < 1.95 || t > 4.2) continue;  // before, it drives off
    const double az = o->get(mrpt::obs::IMU_Z_ACC);
    const double ax = o->get(mrpt::obs::IMU_X_ACC);
    lift = std::max(lift, std::abs(az - 9.81));
    EXPECT_LT(std::hypot(ax, az - 9.81), 15.0) << "hands are not hammers";
  }
  EXPECT_GT(lift, 0.5);

  const Observed unfelt = carried(ride("unfelt"));
  EXPECT_NEAR(turned_by_gyro(unfelt.all), 0.0, 0.01);
  EXPECT_GT(count_between<mrpt::obs::CObservationIMU>(unfelt.all, 2.05, 3.95), 180);

  const Observed off = carried(ride("switched_off"));
  EXPECT_EQ(count_between<mrpt::obs::CObservationIMU>(off.all, 2.05, 3.95), 0);
  EXPECT_EQ(count_between<mrpt::obs::CObservationOdometry>(off.all, 2.05, 3.95), 0);
  EXPECT_NEAR(maps::wrap_angle(off.after.phi - off.before.phi), 120.0 * kDeg, 0.02);
}

TEST(Kidnap, NeverPutsTheRoverWhereItCannotStandOrDriveOn) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const World world = World::random_office(seed);
    const maps::RobotModel robot;
    const PutDownSpots spots(world, robot);
    const auto grid = true_grid(world, 0.02, 0.02, 0.35);
    const auto field = maps::distance_to_occupied(grid);
    for (int i = 0; i < 12; ++i) {
      Kidnap kidnap;
      kidnap.forward_m = 4.0 * std::cos(30.0 * kDeg * i);
      kidnap.left_m = 4.0 * std::sin(30.0 * kDeg * i);
      const TPose2D to = spots.choose(world.start(), kidnap, {});
      EXPECT_GE(maps::clearance_at(grid, field, maps::position_of(to), 1.0), robot.robot_radius_m)
          << world.name() << " " << i;
      EXPECT_TRUE(
          maps::OccupancyGrid::is_free(grid.at(grid.geometry.cell_at(maps::position_of(to)))));
      const double away = maps::distance(maps::position_of(to), maps::position_of(world.start()));
      EXPECT_NEAR(away, 4.0, 0.8) << world.name() << " " << i;
    }
  }
}

TEST(Kidnap, NeverPutsTheRoverIntoASealedRoom) {
  WorldModel model = bare_floor();
  // Four walls round (6, 0), no door; the asked spot is inside.
  for (const double side : {-1.5, 1.5}) {
    model.solids.push_back(box_at(6.0 + side, 0.0, 0.0, {0.1, 3.1, 2.0}));
    model.solids.push_back(box_at(6.0, side, 0.0, {3.1, 0.1, 2.0}));
  }
  model.solids.push_back(box_at(-9.0, 0.0, 0.0, {0.1, 18.0, 2.0}));
  model.solids.push_back(box_at(14.0, 0.0, 0.0, {0.1, 18.0, 2.0}));
  const PutDownSpots spots{World(model), maps::RobotModel()};
  Kidnap kidnap;
  kidnap.forward_m = 6.0;
  const TPose2D to = spots.choose(TPose2D(), kidnap, {});
  EXPECT_GT(std::max(std::abs(to.x - 6.0), std::abs(to.y)), 1.7);
  EXPECT_NEAR(std::hypot(to.x, to.y), 6.0, 0.5);
}

TEST(Kidnap, ADrivenOneEndsWhereTheRoverHasBeen) {
  const World world(bare_floor());
  const PutDownSpots spots(world, maps::RobotModel());
  DrivenTrack track;
  for (double y = 0.0; y <= 5.0; y += 0.1) track.add({0.0, y, 90.0 * kDeg});
  Kidnap kidnap;
  kidnap.where = "driven";
  const TPose2D to = spots.choose({0.0, 5.0, 90.0 * kDeg}, kidnap, track);
  EXPECT_LT(std::abs(to.x), 0.61);
  EXPECT_NEAR(to.y, 1.0, 0.3);
  EXPECT_NEAR(maps::wrap_angle(to.phi - 210.0 * kDeg), 0.0, 1e-9);
}

}  // namespace
}  // namespace rovigo::sim
