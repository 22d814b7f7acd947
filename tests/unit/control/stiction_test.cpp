#include "control/stiction.h"

#include <gtest/gtest.h>

#include <random>

namespace rovigo::control {
namespace {

constexpr double kKnown = 0.045, kTrackM = 0.358, kStepS = 1.0 / 30.0;

/// Commands for some seconds a rover whose wheels stand below `dead_zone`; poses come late and
/// noisy.
double learned(const TTwist2D& wanted, double dead_zone, double seconds, unsigned seed) {
  StictionEstimator stiction(kKnown, kTrackM);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.01);
  constexpr int kLate = 4;
  std::vector<TPose2D> poses(kLate);
  const double rim = std::abs(wanted.vx) + std::abs(wanted.omega) * kTrackM / 2;
  for (int i = 0; i < seconds / kStepS; ++i) {
    // As the tracker does: what is slower than the dead zone it knows of is brought up to it.
    const double lift = rim > 0.0 ? std::max(1.0, stiction.dead_zone_m_s() / rim) : 1.0;
    const TTwist2D command(lift * wanted.vx, 0.0, lift * wanted.omega);
    const double moves = lift * rim >= dead_zone ? kStepS : 0.0;
    poses.push_back({poses.back().x + command.vx * moves, 0.0,
                     maps::wrap_angle(poses.back().phi + command.omega * moves)});
    TPose2D seen = poses[poses.size() - 1 - kLate];
    seen.x += noise(random);
    seen.y += noise(random);
    seen.phi = maps::wrap_angle(seen.phi + noise(random));
    stiction.pose(seen, 0.01);
    stiction.expect(command, command, kStepS);
  }
  return stiction.dead_zone_m_s();
}

TEST(Stiction, ATurnThatDoesNotHappenRaisesTheDeadZone) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    EXPECT_GE(learned({0, 0, 0.1}, 0.06, 6.0, seed), 0.06) << seed;
  }
}

TEST(Stiction, AMotionThatHappensDoesNot) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    EXPECT_EQ(learned({0, 0, 0.4}, 0.06, 10.0, seed), kKnown) << seed;
    EXPECT_EQ(learned({0.08, 0, 0.0}, 0.06, 10.0, seed), kKnown) << seed;
    EXPECT_EQ(learned({0.4, 0, 0.5}, 0.06, 10.0, seed), kKnown) << seed;
  }
}

TEST(Stiction, AWayThatIsNotDrivenRaisesItToo) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    EXPECT_GE(learned({0.02, 0, 0.0}, 0.06, 30.0, seed), 0.06) << seed;
  }
}

TEST(Stiction, ItStopsAtTheHighest) {
  EXPECT_LE(learned({0, 0, 0.1}, 1.0, 120.0, 1), StictionEstimator::kHighest);
}

TEST(Stiction, StandingStillTeachesNothing) { EXPECT_EQ(learned({}, 0.06, 60.0, 1), kKnown); }

}  // namespace
}  // namespace rovigo::control
