#include "slam/keyframe_uncertainty.h"

#include <gtest/gtest.h>

#include "tests/support/pinhole.h"

namespace rovigo::slam {
namespace {

LandmarkMap empty_map() { return {SlamConfig{}, CameraModel(test::pinhole()), Se3{}}; }

double position_sigma(const Keyframe& k) {
  return std::sqrt(k.covariance(0, 0) + k.covariance(1, 1));
}

/// Keyframes half a metre apart, straight on, each tracked from the one before.
std::vector<Keyframe> straight_chain(int count, double floor_roughness = 0.0) {
  MapUncertainty uncertainty;
  std::vector<Keyframe> out;
  for (int i = 0; i < count; ++i) {
    Keyframe k;
    k.map_from_base = from_planar({0.5 * i, 0.0, 0.0});
    k.features.set_floor_roughness(floor_roughness);
    uncertainty.join(k, Eigen::Matrix3d::Zero(), false);
    out.push_back(k);
  }
  return out;
}

TEST(MapUncertainty, TheFirstKeyframeIsWhatAllOthersAreHeldAgainst) {
  MapUncertainty uncertainty;
  Keyframe first;
  uncertainty.join(first, Eigen::Matrix3d::Identity(), true);
  EXPECT_TRUE(first.covariance.isZero());
}

TEST(MapUncertainty, AnErrorOfHeadingSwingsAllThatComesAfterIt) {
  const auto chain = straight_chain(81);
  const Eigen::Matrix3d half = chain[40].covariance, whole = chain[80].covariance;
  EXPECT_NEAR(whole(2, 2), 2 * half(2, 2), 1e-12);
  EXPECT_NEAR(whole(0, 0), 2 * half(0, 0), 1e-12);
  EXPECT_GT(whole(1, 1), 6 * half(1, 1));  // a random walk of heading: the cube of the way
  EXPECT_GT(whole(1, 2), 0.0);
}

TEST(MapUncertainty, GrowsFasterOverAFloorThatIsReadUnevenly) {
  const auto even = straight_chain(21), uneven = straight_chain(21, 0.03);
  EXPECT_GT(position_sigma(uneven.back()), 2.0 * position_sigma(even.back()));
  EXPECT_GT(uneven.back().covariance(2, 2), 2.0 * even.back().covariance(2, 2));
}

TEST(MapUncertainty, DeadReckoningCountsOnceHoweverManyKeyframesItMakes) {
  Keyframe first, one, two, seen;
  first.map_from_base = from_planar({0, 0, 0});
  one.map_from_base = from_planar({0.5, 0, 0});
  two.map_from_base = from_planar({1.0, 0, 0});
  seen.map_from_base = two.map_from_base;
  const Eigen::Matrix3d reckoned = Eigen::Vector3d(0.01, 0.02, 0.001).asDiagonal();
  MapUncertainty blind, tracked;
  blind.join(first, reckoned, false);
  blind.join(one, reckoned, true);
  blind.join(two, 2 * reckoned, true);  // the filter itself adds up since the last look
  tracked.join(first, reckoned, false);
  tracked.join(one, reckoned, false);
  tracked.join(seen, reckoned, false);
  EXPECT_TRUE((two.covariance - seen.covariance).isApprox(2 * reckoned, 1e-9));
  EXPECT_TRUE(blind.at(two.map_from_base).isApprox(seen.covariance, 1e-9));
  blind.see(two);  // a look at what was made blindly inherits all of it
  EXPECT_TRUE(blind.at(two.map_from_base).isApprox(two.covariance, 1e-9));
}

TEST(MapUncertainty, AClosedLoopMakesItsEndAndTheWayToItSurer) {
  const auto chain = straight_chain(41);
  LandmarkMap map = empty_map();
  for (const Keyframe& k : chain) map.add_keyframe(k);
  // Where the last one stands does not matter here but for its distance: it came back.
  map.keyframe(40).map_from_base = from_planar({0.1, 0.0, 0.0});
  map.keyframe(39).map_from_base = from_planar({0.6, 0.0, 0.0});
  share_certainty(0, map);
  EXPECT_LT(position_sigma(map.keyframe(40)), 0.02);
  EXPECT_LT(position_sigma(map.keyframe(39)), 0.02);
  for (int i = 0; i <= 40; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_LE(position_sigma(map.keyframe(i)), position_sigma(chain[k])) << i;
  }
  EXPECT_EQ(map.keyframe(5).covariance, chain[5].covariance);  // nearer the start than the loop
}

}  // namespace
}  // namespace rovigo::slam
