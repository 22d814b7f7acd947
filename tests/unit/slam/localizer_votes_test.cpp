#include "slam/localizer_votes.h"

#include <gtest/gtest.h>

namespace rovigo::slam {
namespace {

Se3 at(double x, double y, double yaw) { return from_planar({x, y, yaw}); }

TEST(PlaceVotes, NobodyWinsWithoutVotes) {
  EXPECT_FALSE(PlaceVotes().best().has_value());
  EXPECT_EQ(PlaceVotes().split(at(0, 0, 0), at(0, 0, 0)).elsewhere, 0.0);
}

TEST(PlaceVotes, ViewsOfATurningRoverVoteTogether) {
  PlaceVotes votes;
  // The rover turns by 0.5 rad; odometry and map agree on that.
  votes.add(0.0, at(3, 2, 1.0), at(0, 0, 0.0), 1.0);
  votes.add(1.0, at(3, 2, 1.5), at(0, 0, 0.5), 0.5);
  ASSERT_TRUE(votes.best().has_value());
  EXPECT_EQ(votes.best()->views, 2);
  EXPECT_DOUBLE_EQ(votes.best()->weight, 1.5);
  const Se3 now = votes.best()->map_from_odom * at(0, 0, 1.0);
  EXPECT_NEAR(to_planar(now).phi, 2.0, 1e-9);
}

TEST(PlaceVotes, ALookAlikeThatDoesNotTurnAlongStaysApart) {
  PlaceVotes votes;
  votes.add(0.0, at(3, 2, 1.0), at(0, 0, 0.0), 1.0);
  votes.add(1.0, at(3, 2, 1.0), at(0, 0, 0.5), 0.8);
  const auto split = votes.split(at(3, 2, 1.5), at(0, 0, 0.5));
  EXPECT_DOUBLE_EQ(split.here, 1.0);
  EXPECT_DOUBLE_EQ(split.elsewhere, 0.8);
}

TEST(PlaceVotes, TheHeavierPlaceWinsAndTheOlderOfTwoEquals) {
  PlaceVotes votes;
  votes.add(0.0, at(1, 0, 0), at(0, 0, 0), 0.5);
  votes.add(0.0, at(5, 0, 0), at(0, 0, 0), 0.5);
  EXPECT_NEAR(votes.best()->map_from_odom.translation.x(), 1.0, 1e-9);
  votes.add(0.0, at(5, 0, 0), at(0, 0, 0), 0.1);
  EXPECT_NEAR(votes.best()->map_from_odom.translation.x(), 5.0, 1e-9);
}

TEST(PlaceVotes, OldVotesFadeAway) {
  PlaceVotes votes;
  votes.add(0.0, at(1, 0, 0), at(0, 0, 0), 1.0);
  for (int i = 0; i < 34; ++i) votes.fade();
  EXPECT_NEAR(votes.best()->weight, 0.5, 0.01);
  for (int i = 0; i < 300; ++i) votes.fade();
  EXPECT_FALSE(votes.best().has_value());
}

TEST(PlaceVotes, ARefutedPlaceHasNoVotes) {
  PlaceVotes votes;
  votes.add(0.0, at(1, 0, 0), at(0, 0, 0), 1.0);
  votes.add(0.0, at(5, 0, 0), at(0, 0, 0), 0.5);
  votes.refute(at(1, 0, 0.05), at(0, 0, 0));
  EXPECT_NEAR(votes.best()->map_from_odom.translation.x(), 5.0, 1e-9);
}

}  // namespace
}  // namespace rovigo::slam
