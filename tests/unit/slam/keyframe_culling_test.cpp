#include "slam/keyframe_culling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "slam/bundle_adjustment.h"
#include "tests/support/landmark_room.h"

namespace rovigo::slam {
namespace {

using namespace test;

/// So many looks at one wall, a hand's breadth apart.
std::vector<TPose2D> looks(int count) {
  std::vector<TPose2D> out;
  for (int i = 0; i < count; ++i) out.push_back({0.1 * (i % 5), 0.05 * (i % 3), 0.0});
  return out;
}

LandmarkMap revisited_map(int count) {
  return room_map(Room(100), looks(count), looks(count), 0.3, 0.005);
}

void cull_all(LandmarkMap& map) {
  while (const auto c = dispensable_keyframe(map)) map.cull_keyframe(c->keyframe, c->host);
}

TEST(KeyframeCulling, RevisitsLeaveNoMoreKeyframesThanTheLatestAndAFew) {
  LandmarkMap few = revisited_map(40), many = revisited_map(80);
  cull_all(few);
  cull_all(many);
  EXPECT_LT(few.living_keyframes(), 25);
  EXPECT_EQ(many.living_keyframes(), few.living_keyframes());
  EXPECT_FALSE(many.keyframe(0).culled());
  EXPECT_FALSE(many.keyframes().back().culled());
}

TEST(KeyframeCulling, AChainThatSeesSomethingNewAtEachStepIsKept) {
  std::vector<TPose2D> turning;
  for (int i = 0; i < 20; ++i) turning.push_back({0, 0, 0.3 * i});
  Room room(0);
  std::mt19937_64 random(5);
  for (int i = 0; i < 600; ++i) {
    const double a = 2 * maps::kPi * i / 600.0;
    room.where.emplace_back(3 * std::cos(a), 3 * std::sin(a), 0.25 + 0.1 * (i % 5));
    room.look.push_back({random(), random(), random(), random()});
  }
  LandmarkMap map = room_map(room, turning, turning, 0.3, 0.005);
  cull_all(map);
  EXPECT_EQ(map.living_keyframes(), 20);
}

TEST(KeyframeCulling, WhatHangsOnACulledKeyframeFollowsItsHost) {
  LandmarkMap map = revisited_map(40);
  const auto culling = dispensable_keyframe(map);
  ASSERT_TRUE(culling);
  const Se3 before = map.keyframe(culling->keyframe).map_from_base;
  map.cull_keyframe(culling->keyframe, culling->host);
  EXPECT_EQ(map.keyframe(culling->keyframe).features.size(), 0u);
  for (const Landmark& l : map.landmarks()) {
    for (const Sighting& s : l.sightings) EXPECT_NE(s.keyframe, culling->keyframe);
  }
  const Se3 moved = from_planar({1.0, -2.0, 0.5});
  std::vector<Se3> poses;
  for (const Keyframe& k : map.keyframes()) poses.push_back(moved * k.map_from_base);
  poses[static_cast<std::size_t>(culling->keyframe)] = Se3{};  // nobody optimises it any more
  map.move_keyframes(poses);
  const Se3 expected = moved * before;
  const Se3& found = map.keyframe(culling->keyframe).map_from_base;
  EXPECT_LT((found.translation - expected.translation).norm(), 1e-9);
  EXPECT_LT((found.rotation - expected.rotation).norm(), 1e-9);
}

TEST(KeyframeCulling, TheBundleStillConvergesOnWhatIsLeft) {
  const auto truth = looks(40);
  auto believed = truth;
  for (std::size_t i = 1; i < believed.size(); ++i) believed[i].x += i % 2 == 0 ? 0.02 : -0.02;
  LandmarkMap map = room_map(Room(100), truth, believed, 0.3, 0.005);
  cull_all(map);
  ASSERT_LT(map.living_keyframes(), 40);
  ASSERT_TRUE(adjust_bundle(map, {}, {}, {.iterations = 20}).converged);
  for (const Keyframe& k : map.keyframes()) {
    if (k.culled()) continue;
    EXPECT_NEAR(k.map_from_base.translation.x(), truth[static_cast<std::size_t>(k.id)].x, 0.01);
  }
}

TEST(KeyframeCulling, NumbersOfDeadLandmarksServeAgain) {
  const Room room(60);
  LandmarkMap map = room_map(room, {{0, 0, 0}}, {{0, 0, 0}}, 0.0, 0.0);
  const std::size_t count = map.landmarks().size();
  map.landmark(3).predicted = 20;
  map.cull({3});
  ASSERT_FALSE(map.landmark(3).alive);
  Keyframe k;
  std::vector<int> points;
  k.features = room.seen_from(Se3{}, 0, 0, 9, points);
  const std::size_t added = k.features.size();
  map.add_keyframe(std::move(k));
  EXPECT_TRUE(map.landmark(3).alive);
  EXPECT_EQ(map.landmark(3).tracked, 0);
  EXPECT_EQ(map.landmark(3).sightings.size(), 1u);
  EXPECT_EQ(map.landmarks().size(), count + added - 1);
}

TEST(KeyframeCulling, ForgottenFeaturesLeaveSightingsWhereTheyAre) {
  LandmarkMap map = revisited_map(3);
  map.landmark(map.keyframe(2).landmark_of[0]).predicted = 20;  // too many views: stays
  map.remove_sighting(map.keyframe(2).landmark_of[1], 2);
  const std::size_t before = map.keyframe(2).features.size();
  map.forget_unmatched(2);
  const Keyframe& k = map.keyframe(2);
  ASSERT_EQ(k.features.size(), before - 1);
  for (std::size_t i = 0; i < k.features.size(); ++i) {
    const auto& seen = map.landmark(k.landmark_of[i]).sightings;
    EXPECT_TRUE(std::any_of(seen.begin(), seen.end(), [&](const Sighting& s) {
      return s.keyframe == 2 && s.feature == static_cast<int>(i);
    }));
  }
}

MotionLink link(int from, int to, double begin_s, const TPose2D& motion) {
  MotionLink l;
  l.from = from;
  l.to = to;
  l.begin_s = begin_s;
  l.end_s = begin_s + 1.0;
  l.from_from_to = motion;
  l.by_calibration << 0, motion.x, 0, 0, 0, motion.y, 0, 0, -1, 0, 0, 0.3;
  l.covariance.diagonal() << 1e-4, 2e-4, 1e-5;
  return l;
}

TEST(KeyframeCulling, TwoLinksThatMetInTheKeyframeBecomeOne) {
  LandmarkMap map = revisited_map(4);
  std::vector<MotionLink> links{link(0, 1, 0.0, {0.3, 0.0, 0.5}), link(1, 2, 1.0, {0.2, 0.1, 0.1})};
  rehang_links(map, {.keyframe = 1, .host = 3}, links);
  ASSERT_EQ(links.size(), 1u);
  EXPECT_EQ(links[0].from, 0);
  EXPECT_EQ(links[0].to, 2);
  const TPose2D both = maps::compose(TPose2D{0.3, 0.0, 0.5}, TPose2D{0.2, 0.1, 0.1});
  EXPECT_NEAR(links[0].from_from_to.x, both.x, 1e-12);
  EXPECT_NEAR(links[0].from_from_to.y, both.y, 1e-12);
  EXPECT_NEAR(links[0].from_from_to.phi, both.phi, 1e-12);
  EXPECT_DOUBLE_EQ(links[0].end_s, 2.0);
  EXPECT_GT(links[0].covariance.trace(), 3.1e-4 * 2);
}

TEST(KeyframeCulling, AChainedLinkFollowsTheCalibrationAsItsPartsDo) {
  const MotionLink a = link(0, 1, 0.0, {0.3, 0.0, 0.5}), b = link(1, 2, 1.0, {0.2, 0.1, 0.1});
  const MotionCalibration other(1e-4, 1e-3, 0.0, 2e-3);
  const TPose2D parts = maps::compose(a.under(other), b.under(other));
  const TPose2D whole = chained(a, b).under(other);
  EXPECT_NEAR(whole.x, parts.x, 1e-6);
  EXPECT_NEAR(whole.y, parts.y, 1e-6);
  EXPECT_NEAR(whole.phi, parts.phi, 1e-12);
}

TEST(KeyframeCulling, AnEdgeOfACulledKeyframeMeasuresTheSameFromItsHost) {
  const LandmarkMap map = revisited_map(6);
  const auto between = [&](int a, int b) {
    return map.keyframe(a).map_from_base.inverse() * map.keyframe(b).map_from_base;
  };
  std::vector<PoseGraphEdge> edges(3);
  edges[0].from = 0, edges[0].to = 2, edges[0].from_from_to = between(0, 2);
  edges[1].from = 2, edges[1].to = 5, edges[1].from_from_to = between(2, 5);
  edges[2].from = 2, edges[2].to = 4, edges[2].from_from_to = between(2, 4);
  rehang_edges(map, {.keyframe = 2, .host = 4}, edges);
  ASSERT_EQ(edges.size(), 2u);  // the third tied the keyframe to its host
  for (const PoseGraphEdge& e : edges) {
    EXPECT_TRUE(e.from == 4 || e.to == 4);
    const Se3 expected = between(e.from, e.to);
    EXPECT_LT((e.from_from_to.translation - expected.translation).norm(), 1e-9);
    EXPECT_LT((e.from_from_to.rotation - expected.rotation).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace rovigo::slam
