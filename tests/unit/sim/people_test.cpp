#include "sim/people.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "test_worlds.h"

namespace rovigo::sim {
namespace {

World lab() { return World::load(ROVIGO_SOURCE_DIR "/sim/worlds/lab.sdf"); }

/// A rover that drives a slow circle about where rovers are put down.
TPose2D rover_at(const World& world, double time_s) {
  const double a = 0.2 * time_s;
  return maps::compose(world.start(), TPose2D(0.5 * std::sin(a), 0.5 - 0.5 * std::cos(a), a));
}

struct Walk {
  double nearest_rover_m = 1e9;
  double fastest_m_s = 0.0;
  double hardest_m_s2 = 0.0;
  double walked_m = 0.0;
  int in_front = 0;  ///< of the camera, within 4 m and 35 deg, per person and step
  int steps = 0;
  int jumps = 0;  ///< came in anew, elsewhere
};

Walk watch(const World& world, std::uint64_t seed, double seconds,
           const std::function<void(const TPoint2D&)>& visit = {}) {
  PeopleSettings settings;
  settings.count = 2;
  People people(world, settings, rover_at(world, 0.0), seed);
  auto before = people.persons();
  Walk walk;
  for (double t = 0.0; t < seconds; t += People::kStepS, ++walk.steps) {
    const TPose2D rover = rover_at(world, t);
    people.step(rover);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const auto& now = people.persons()[i];
      const TPoint2D seen = maps::transform(maps::inverse(rover), now.at);
      const double step_m = maps::distance(now.at, before[i].at);
      walk.nearest_rover_m = std::min(walk.nearest_rover_m, seen.norm());
      walk.in_front += seen.norm() < 4.0 && std::abs(std::atan2(seen.y, seen.x)) < 0.61;
      if (step_m > 0.2) {
        ++walk.jumps;
      } else {
        walk.walked_m += step_m;
        walk.fastest_m_s = std::max(walk.fastest_m_s, step_m / People::kStepS);
        walk.hardest_m_s2 = std::max(walk.hardest_m_s2,
                                     (now.velocity - before[i].velocity).norm() / People::kStepS);
      }
      if (visit) visit(now.at);
    }
    before = people.persons();
  }
  return walk;
}

TEST(People, KeepAwayFromTheRoverAndWalkSmoothlyThroughItsView) {
  for (const auto& world : {lab(), World::random_office(3), World::random_office(11)}) {
    SCOPED_TRACE(world.name());
    const Walk walk = watch(world, 5, 40.0);
    EXPECT_GE(walk.nearest_rover_m, 0.6 + 0.25);
    EXPECT_LE(walk.fastest_m_s, 1.2 + 1e-6);
    EXPECT_LE(walk.hardest_m_s2, 2.0 * 1.2 / 0.3 + 1e-6);
    EXPECT_GE(walk.walked_m, 0.3 * 2 * 40.0) << "they stand about";
    EXPECT_GE(walk.in_front, 0.15 * 2 * walk.steps) << "the camera hardly sees them";
  }
}

TEST(People, NeverWalkThroughWallsOrFurniture) {
  for (const auto& world : {lab(), World::random_office(3), World::random_office(11)}) {
    SCOPED_TRACE(world.name());
    const auto grid = true_grid(world, 0.05, 0.05, 1.8);
    const auto field = maps::distance_to_occupied(grid);
    double nearest = 1e9;
    watch(world, 9, 40.0, [&](const TPoint2D& p) {
      nearest = std::min(nearest, maps::clearance_at(grid, field, p, 1.0));
    });
    EXPECT_GE(nearest, 0.18);
  }
}

TEST(People, OneSeedGivesOneWalkAndAnotherSeedAnother) {
  const World world = lab();
  const auto end_of_walk = [&](std::uint64_t seed) {
    TPoint2D last;
    watch(world, seed, 5.0, [&](const TPoint2D& p) { last = p; });
    return last;
  };
  EXPECT_EQ(end_of_walk(1).x, end_of_walk(1).x);
  EXPECT_GT(maps::distance(end_of_walk(1), end_of_walk(2)), 1e-3);
}

TEST(People, StandOnTheFloorWithAHeadOnTop) {
  for (const double phase : {0.0, 0.8, 1.6, 2.4, 3.2, 4.0, 4.8, 5.6}) {
    People::Person person;
    person.at = {2.0, 1.0};
    person.velocity = {0.9, 0.0};
    person.stride_rad = phase;
    double low = 1e9;
    double high = -1e9;
    for (const auto& solid : person_body(person, 0)) {
      for (const auto& p : corners_of(solid)) {
        low = std::min(low, p.z());
        high = std::max(high, p.z());
        EXPECT_LT(std::hypot(p.x() - 2.0, p.y() - 1.0), 0.75);
      }
    }
    EXPECT_GE(low, -0.02);
    EXPECT_LE(low, 0.05);
    EXPECT_NEAR(high, 1.72, 0.08);
  }
}

TEST(People, AreSeenByTheCameraButAreInNoTrueGridAndTouchNothing) {
  Scenario scenario = ideal_scenario();
  scenario.people.count = 2;
  SimulatorOptions options;
  options.scenario = scenario;
  options.camera_rate_hz = 2.0;
  const World world(wall_ahead(5.0));
  Simulator with(world, options);
  options.scenario.people.count = 0;
  Simulator without(world, options);
  int nearer = 0;
  for (int i = 0; i < 10 * 240; ++i) {
    with.step({});
    without.step({});
    const auto a = only<mrpt::obs::CObservation3DRangeScan>(with.take_observations());
    const auto b = only<mrpt::obs::CObservation3DRangeScan>(without.take_observations());
    for (std::size_t k = 0; k < a.size(); ++k) {
      for (int y = 0; y < 480; ++y) {
        for (int x = 0; x < 640; ++x) {
          const int here = a[k]->rangeImage(y, x);
          nearer += here > 0 && here + 500 < b[k]->rangeImage(y, x);
        }
      }
    }
  }
  EXPECT_GT(nearer, 20 * 5000) << "pixels of 20 frames that a person covers";
  EXPECT_EQ(with.truth().contact_events, 0);
}

}  // namespace
}  // namespace rovigo::sim
