#include "slam/place_finder.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "tests/support/depth_room.h"

namespace rovigo::slam {
namespace {

using test::DepthRoom;

/// A map of the room whose keyframes looked around at two places.
maps::SavedMap map_of(const DepthRoom& room) {
  maps::SavedMap map;
  map.grid = room.grid();
  for (const TPoint2D& at : {TPoint2D{1.2, 2.0}, TPoint2D{4.0, 1.8}}) {
    for (double heading = -3.0; heading < 3.0; heading += 0.5) {
      maps::StoredKeyframe k;
      k.id = static_cast<int>(map.keyframes.size());
      const TPose2D pose{at.x, at.y, heading};
      k.map_from_base = to_mrpt(from_planar(pose));
      cv::imencode(".png", room.depth(pose), k.depth_png);
      map.keyframes.push_back(std::move(k));
    }
  }
  return map;
}

DepthMemory depths_of(const maps::SavedMap& map) {
  DepthMemory depths(DepthRoom::camera(), DepthRoom::base_from_camera());
  for (const auto& k : map.keyframes) depths.add(from_mrpt(k.map_from_base), k.depth_png);
  return depths;
}

/// A rover that knows only its own motion since it was put down at `start`.
struct Rover {
  Rover(const DepthRoom& r, const maps::SavedMap& map, const TPose2D& at)
      : room(r), start(at), finder(map.grid, depths_of(map)) {}

  void turns_to(double turned_rad, bool searches = true, bool jumped = false) {
    odom = {0.0, 0.0, maps::wrap_angle(turned_rad)};
    truth = maps::compose(start, odom);
    const cv::Mat depth = room.depth(truth);
    SlamConfig config;
    const auto scan =
        obstacle_points(depth, 0.001, DepthRoom::camera(), DepthRoom::base_from_camera(), config);
    if (finder.see(time_s += 0.2, from_planar(odom), scan, depth, 0.001, jumped) && searches) {
      finder.search(from_planar(odom), std::nullopt);
    }
  }
  void turns_around() {
    for (double turned = 0.0; turned < 6.0; turned += 0.2) turns_to(turned);
  }
  double error_m() const {
    const auto best = finder.best();
    if (!best) return 1e9;
    const TPose2D pose = to_planar(best->map_from_odom * from_planar(odom));
    return maps::distance(maps::position_of(pose), maps::position_of(truth));
  }

  DepthRoom room;
  TPose2D start, odom, truth;
  PlaceFinder finder;
  double time_s = 0.0;
};

TEST(PlaceFinder, ShapeAloneFindsARoverThatTurnsInAnOddRoom) {
  const DepthRoom room = test::odd_room();
  const maps::SavedMap map = map_of(room);
  for (const TPose2D& start :
       {TPose2D{1.0, 1.2, 2.0}, TPose2D{4.1, 2.4, -1.0}, TPose2D{5.0, 1.0, 0.5}}) {
    Rover rover(room, map, start);
    rover.turns_around();
    EXPECT_LT(rover.error_m(), 0.1) << start.asString();
    const PlaceSupport support =
        rover.finder.support(from_planar(rover.truth), from_planar(rover.odom));
    EXPECT_GT(support.scan_share, 0.95);
    EXPECT_GT(support.surface_share, 0.9);
    EXPECT_GT(support.shape - support.rival_shape, 0.05);
  }
}

TEST(PlaceFinder, ASquareRoomLeavesRivalsUntilAViewIsRecognised) {
  const DepthRoom room = test::square_room();
  Rover rover(room, map_of(room), {1.0, 1.3, 0.4});
  rover.turns_around();
  const Se3 here = from_planar(rover.truth), odom = from_planar(rover.odom);
  const PlaceSupport support = rover.finder.support(here, odom);
  EXPECT_LT(support.shape - support.rival_shape, 0.1);
  rover.finder.recognize(here, odom, 1.0);
  EXPECT_LT(rover.error_m(), 0.2) << "one clear view picks the corner";
}

TEST(PlaceFinder, ALookAlikeIsOutvotedByTheShapeOfWhatStandsAround) {
  const DepthRoom room = test::odd_room();
  Rover rover(room, map_of(room), {1.0, 1.2, 2.0});
  rover.turns_to(0.0);
  const TPose2D elsewhere = maps::compose(rover.truth, TPose2D{1.5, -0.5, 1.0});
  rover.finder.recognize(from_planar(elsewhere), from_planar(rover.odom), 2.0);
  rover.turns_around();
  EXPECT_LT(rover.error_m(), 0.1);
  const PlaceSupport support =
      rover.finder.support(from_planar(rover.truth), from_planar(rover.odom));
  EXPECT_EQ(support.rival_recognitions, 0.0) << "refuted: no rival any more";
}

// A rover that has just turned from a blank wall: enough points to judge a place by, none searched.
TEST(PlaceFinder, BeforeTheGridWasSearchedNoPlaceIsUnrivalled) {
  const DepthRoom room = test::odd_room();
  Rover rover(room, map_of(room), {1.0, 1.2, 2.0});
  for (double turned = 0.0; turned < 3.0; turned += 0.2) rover.turns_to(turned, false);
  const Se3 here = from_planar(rover.truth), odom = from_planar(rover.odom);
  rover.finder.recognize(here, odom, 1.0);
  const PlaceSupport before = rover.finder.support(here, odom);
  EXPECT_GT(before.shape, 0.8);
  EXPECT_LE(before.shape - before.rival_shape, 0.0);
  rover.finder.search(odom, std::nullopt);
  const PlaceSupport after = rover.finder.support(here, odom);
  EXPECT_GT(after.shape - after.rival_shape, 0.0);
}

// Keyframes that looked this way, hardly this way, and not at all.
TEST(PlaceFinder, AGlimpseOfWhatKeyframesSawSaysLessThanAView) {
  const DepthRoom room = test::odd_room();
  const TPose2D start{1.2, 2.0, 0.4};
  const auto share_with_keyframe_at = [&](double heading) {
    maps::SavedMap map;
    map.grid = room.grid();
    maps::StoredKeyframe k;
    const TPose2D pose{start.x, start.y, heading};
    k.map_from_base = to_mrpt(from_planar(pose));
    cv::imencode(".png", room.depth(pose), k.depth_png);
    map.keyframes.push_back(std::move(k));
    Rover rover(room, map, start);
    rover.turns_to(0.0);
    return rover.finder.support(from_planar(start), Se3{}).surface_share;
  };
  const double whole = share_with_keyframe_at(0.4), glimpse = share_with_keyframe_at(1.09);
  EXPECT_DOUBLE_EQ(share_with_keyframe_at(3.0), PlaceCandidate::kUnjudgedShare);
  EXPECT_GT(glimpse, PlaceCandidate::kUnjudgedShare);
  EXPECT_LT(glimpse, whole - 0.01);
  EXPECT_GT(whole, 0.97);
}

TEST(PlaceFinder, APlaceThatLedToContradictionGivesWayToAnother) {
  PlaceFinder finder(maps::OccupancyGrid{}, depths_of({}));
  const Se3 here = from_planar({1, 2, 3}), there = from_planar({4, 2, 0});
  finder.recognize(here, Se3{}, 1.0);
  finder.recognize(there, Se3{}, 0.4);
  finder.refute(here, Se3{});
  ASSERT_TRUE(finder.best());
  EXPECT_NEAR(finder.best()->map_from_odom.translation.x(), 4.0, 1e-9);
}

TEST(PlaceFinder, RecognitionsFadeAndAreForgotten) {
  const DepthRoom room = test::odd_room();
  Rover rover(room, map_of(room), {1.0, 1.2, 2.0});
  rover.finder.recognize(from_planar(rover.start), Se3{}, 1.0);
  EXPECT_DOUBLE_EQ(rover.finder.support(from_planar(rover.start), Se3{}).recognitions, 1.0);
  for (int i = 0; i < 34; ++i) rover.finder.fade();
  EXPECT_NEAR(rover.finder.support(from_planar(rover.start), Se3{}).recognitions, 0.5, 0.02);
  rover.finder.clear_before(1.0);
  EXPECT_FALSE(rover.finder.best());
}

TEST(PlaceFinder, WhatWasSeenSinceTheRoverWasCarriedStillTellsWhereItIs) {
  const DepthRoom room = test::odd_room();
  Rover rover(room, map_of(room), {1.0, 1.2, 2.0});
  for (double turned = 0.0; turned < 1.5; turned += 0.2) rover.turns_to(turned, false);
  const double carried_s = rover.time_s + 0.1;
  const TPose2D put_down{3.0, 2.0, -1.0};
  rover.start = maps::compose(put_down, maps::inverse(rover.odom));  // which odometry knows not of
  rover.turns_to(1.4, false, true);
  for (double turned = 1.6; turned < 6.0; turned += 0.2) rover.turns_to(turned, false);
  rover.finder.clear_before(carried_s);
  rover.turns_to(6.05);  // hardly more than before: the views that were kept are searched
  EXPECT_LT(rover.error_m(), 0.1);
}

TEST(PlaceFinder, WithoutAGridAppearanceAloneDecides) {
  PlaceFinder finder(maps::OccupancyGrid{}, depths_of({}));
  EXPECT_FALSE(finder.has_grid());
  const Se3 here = from_planar({1, 2, 3}), there = from_planar({4, 2, 0});
  finder.recognize(here, Se3{}, 1.0);
  finder.recognize(there, Se3{}, 0.4);
  finder.search(Se3{}, std::nullopt);
  ASSERT_TRUE(finder.best());
  EXPECT_NEAR(finder.support(here, Se3{}).rival_recognition_share(), 0.4 / 1.4, 1e-9);
}

TEST(PlaceFinder, FeaturesSayMoreAboutAPlaceThanTheShapeThatProposedIt) {
  const DepthRoom room = test::odd_room();
  const maps::SavedMap map = map_of(room);
  Rover rover(room, map, {1.0, 1.2, 2.0});
  rover.turns_around();
  TPose2D seen = rover.truth;
  seen.x += 0.15;
  rover.finder.recognize(from_planar(seen), from_planar(rover.odom), 1.0);
  const auto best = rover.finder.best();
  ASSERT_TRUE(best);
  const TPose2D at = to_planar(best->map_from_odom * from_planar(rover.odom));
  EXPECT_LT(maps::distance(maps::position_of(at), maps::position_of(seen)), 1e-9);
}

TEST(PlaceFinder, ARefutedPlaceStaysTheBestWhereNoOtherFits) {
  const DepthRoom room = test::odd_room();
  const maps::SavedMap map = map_of(room);
  Rover rover(room, map, {1.0, 1.2, 2.0});
  rover.turns_around();
  const Se3 odom = from_planar(rover.odom);
  const auto best = rover.finder.best();
  ASSERT_TRUE(best);
  const Se3 here = best->map_from_odom * odom;
  rover.finder.refute(here, odom);
  EXPECT_TRUE(rover.finder.is_best(here, odom));
  Se3 away = here;
  away.translation.x() += 2.0;
  EXPECT_FALSE(rover.finder.is_best(away, odom));
  rover.finder.recognize(away, odom, 1.0);
  for (int i = 0; i < 20; ++i) rover.finder.refute(here, odom);
  EXPECT_FALSE(rover.finder.is_best(here, odom)) << "contradictions add up";
}

}  // namespace
}  // namespace rovigo::slam
