#include "slam/wall_revisits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/pinhole.h"
#include "tests/support/wall_scene.h"

namespace rovigo::slam {
namespace {

using test::scan_of;
using test::Wall;

const std::vector<Wall> kRoom = {
    {{-4, -2}, {4, -2}}, {{4, -2}, {4, 2}}, {{4, 2}, {-4, 2}}, {{-4, 2}, {-4, -2}}};
// Two views of the room's corner at (4, 2).
const TPose2D kThere(-1, 1, 0.1), kHere(3, -1.5, 1.3);

LandmarkMap empty_map() { return {SlamConfig{}, CameraModel(test::pinhole()), Se3{}}; }

/// A view that stands at `truth` and is believed at `believed`.
void add_view(LandmarkMap& map, double time_s, const std::vector<Wall>& walls, const TPose2D& truth,
              const TPose2D& believed) {
  Keyframe k;
  k.time_s = time_s;
  k.map_from_base = from_planar(believed);
  k.walls = scan_of(walls, truth, static_cast<std::uint64_t>(time_s));
  map.add_keyframe(std::move(k));
}

TPose2D drifted(const TPose2D& truth) {
  return {truth.x + 0.05, truth.y - 0.06, truth.phi + 0.015};
}

TEST(WallRevisits, ACornerSeenFromElsewhereTiesTheView) {
  LandmarkMap map = empty_map();
  add_view(map, 1.0, kRoom, kThere, kThere);
  add_view(map, 60.0, kRoom, kHere, drifted(kHere));
  const std::vector<MotionLink> links = wall_revisits(map);
  ASSERT_EQ(links.size(), 1u);
  EXPECT_EQ(links[0].from, 0);
  EXPECT_EQ(links[0].to, 1);
  const TPose2D truth = maps::compose(maps::inverse(kThere), kHere);
  EXPECT_NEAR(links[0].from_from_to.x, truth.x, 0.01);
  EXPECT_NEAR(links[0].from_from_to.y, truth.y, 0.01);
  EXPECT_NEAR(links[0].from_from_to.phi, truth.phi, 0.006);
  EXPECT_LT(std::sqrt(links[0].covariance(0, 0)), 0.03);
}

TEST(WallRevisits, AlongAPlainCorridorTheTieSaysNothing) {
  const std::vector<Wall> corridor = {{{-20, 1}, {20, 1}}, {{20, -1}, {-20, -1}}};
  const TPose2D there(0, 0, 0), here(5, 0, M_PI);
  LandmarkMap map = empty_map();
  add_view(map, 1.0, corridor, there, there);
  add_view(map, 60.0, corridor, here, drifted(here));
  const std::vector<MotionLink> links = wall_revisits(map);
  ASSERT_EQ(links.size(), 1u);
  EXPECT_GT(std::sqrt(links[0].covariance(0, 0)), 0.5) << "along it";
  EXPECT_LT(std::sqrt(links[0].covariance(1, 1)), 0.03) << "across it";
}

TEST(WallRevisits, NoTieToWhatWasSeenJustNowOrNeverOrWouldMoveFar) {
  LandmarkMap soon = empty_map();
  add_view(soon, 1.0, kRoom, kThere, kThere);
  add_view(soon, 10.0, kRoom, kHere, drifted(kHere));
  EXPECT_TRUE(wall_revisits(soon).empty());

  LandmarkMap far = empty_map();
  add_view(far, 1.0, kRoom, kThere, kThere);
  add_view(far, 60.0, kRoom, kHere, {kHere.x + 0.5, kHere.y + 0.5, kHere.phi + 0.1});
  EXPECT_TRUE(wall_revisits(far).empty());

  EXPECT_TRUE(wall_revisits(empty_map()).empty());
}

}  // namespace
}  // namespace rovigo::slam
