#include "slam/landmark_map.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "maps/error.h"
#include "slam/bundle_adjustment.h"
#include "slam/local_map.h"
#include "slam/map_storage.h"
#include "slam/place_match.h"
#include "tests/support/landmark_room.h"

namespace rovigo::slam {
namespace {

using namespace test;

const std::vector<TPose2D> kLine = {{0, 0, 0}, {0.2, 0.1, 0.05}, {0.4, 0.0, -0.05}, {0.6, 0.1, 0}};

TEST(LandmarkMap, NewFeaturesWithDepthBecomeLandmarksWhereTheyAre) {
  const Room room(100);
  const LandmarkMap map = room_map(room, {kLine[0]}, {kLine[0]}, 0.0, 0.0);
  ASSERT_GT(map.landmarks().size(), 50u);
  double nearest_sum = 0.0;
  for (const Landmark& l : map.landmarks()) {
    double nearest = 1e9;
    for (const auto& p : room.where) nearest = std::min(nearest, (p - l.position_map).norm());
    nearest_sum += nearest;
  }
  EXPECT_LT(nearest_sum / static_cast<double>(map.landmarks().size()), 1e-4);
}

TEST(LandmarkMap, SeeingALandmarkAgainSharpensIt) {
  const Room room(100);
  const LandmarkMap once = room_map(room, {kLine[0]}, {kLine[0]}, 0.5, 0.01);
  const LandmarkMap often = room_map(room, kLine, kLine, 0.5, 0.01);
  EXPECT_LT(often.landmark(0).covariance.trace(), once.landmark(0).covariance.trace());
  EXPECT_EQ(often.landmark(0).sightings.size(), 4u);
}

TEST(LandmarkMap, KeyframesThatShareLandmarksAreCovisible) {
  const Room room(100);
  const LandmarkMap map = room_map(room, kLine, kLine, 0.0, 0.0);
  const auto relatives = map.covisible(3, 10);
  ASSERT_EQ(relatives.size(), 3u);
  EXPECT_GE(relatives[0].second, relatives[2].second);
}

TEST(LandmarkMap, MergedLandmarksBecomeOneSeenByAll) {
  const Room room(60);
  LandmarkMap map = room_map(room, {kLine[0], kLine[1]}, {kLine[0], kLine[1]}, 0.0, 0.0);
  // A third keyframe that recognised nothing makes landmarks of its own; merge the first pair.
  Keyframe k;
  std::vector<int> points;
  k.map_from_base = from_planar(kLine[2]);
  k.features = room.seen_from(k.map_from_base, 0, 0, 9, points);
  const int id = map.add_keyframe(std::move(k));
  const int twin = map.keyframe(id).landmark_of[0];
  const int original = 0;
  map.merge_landmarks(twin, original);
  EXPECT_FALSE(map.landmark(twin).alive);
  EXPECT_EQ(map.keyframe(id).landmark_of[0], original);
  EXPECT_EQ(map.landmark(original).sightings.back().keyframe, id);
}

TEST(LandmarkMap, LandmarksThatAreNeverFoundAgainAreCulled) {
  const Room room(60);
  LandmarkMap map = room_map(room, {kLine[0]}, {kLine[0]}, 0.0, 0.0);
  map.landmark(0).predicted = 20;
  map.landmark(0).tracked = 1;
  map.landmark(1).predicted = 20;
  map.landmark(1).tracked = 15;
  map.cull({0, 1});
  EXPECT_FALSE(map.landmark(0).alive);
  EXPECT_TRUE(map.landmark(1).alive);
}

TEST(LandmarkMap, ASavedMapComesBackWithItsLandmarks) {
  const Room room(100);
  LandmarkMap map = room_map(room, kLine, kLine, 0.3, 0.005);
  maps::SavedMap saved;
  saved.metadata.camera = intrinsics();
  saved.metadata.base_from_camera = to_mrpt(forward_camera());
  saved.keyframes = hand_over_keyframes(map);
  const LandmarkMap back = restore_landmark_map(saved, SlamConfig{});
  ASSERT_EQ(back.keyframes().size(), map.keyframes().size());
  ASSERT_EQ(back.landmarks().size(), map.landmarks().size());
  for (std::size_t i = 0; i < map.keyframes().size(); ++i) {
    const int a = map.keyframes()[i].landmark_of[0], b = back.keyframes()[i].landmark_of[0];
    EXPECT_LT((map.landmark(a).position_map - back.landmark(b).position_map).norm(), 1e-5);
    EXPECT_EQ(back.landmark(b).sightings.size(), map.landmark(a).sightings.size());
  }
}

TEST(LandmarkMap, ASavedMapWithDamagedFeaturesIsRefused) {
  maps::SavedMap saved;
  saved.metadata.camera = intrinsics();
  saved.keyframes.emplace_back();
  saved.keyframes[0].features = {1, 2, 3};
  EXPECT_THROW(restore_landmark_map(saved, SlamConfig{}), maps::InputError);
}

TEST(BundleAdjustment, BringsDisplacedKeyframesBack) {
  const Room room(150);
  std::vector<TPose2D> believed = kLine;
  believed[1].x += 0.03;
  believed[2].phi += 0.02;
  believed[3].y -= 0.03;
  LandmarkMap map = room_map(room, kLine, believed, 0.4, 0.005);
  const BundleResult r = adjust_bundle(map, {}, {}, {.iterations = 20, .on_floor = true});
  ASSERT_TRUE(r.converged);
  EXPECT_LT(r.final_cost, r.initial_cost);
  for (std::size_t i = 0; i < kLine.size(); ++i) {
    const TPose2D found = to_planar(map.keyframes()[i].map_from_base);
    EXPECT_NEAR(found.x, kLine[i].x, 0.008) << i;
    EXPECT_NEAR(found.y, kLine[i].y, 0.008) << i;
    EXPECT_NEAR(found.phi, kLine[i].phi, 0.004) << i;
  }
}

TEST(BundleAdjustment, SightingsOfTheWrongPointAreTakenOut) {
  const Room room(150);
  LandmarkMap map = room_map(room, kLine, kLine, 0.3, 0.005);
  // Two landmarks of the last keyframe change places.
  Keyframe& last = map.keyframe(3);
  const int a = last.landmark_of[0], b = last.landmark_of[5];
  std::swap(last.landmark_of[0], last.landmark_of[5]);
  for (Sighting& s : map.landmark(a).sightings) {
    if (s.keyframe == 3) s.feature = 5;
  }
  for (Sighting& s : map.landmark(b).sightings) {
    if (s.keyframe == 3) s.feature = 0;
  }
  const BundleResult r = adjust_bundle(map, {}, {}, {.iterations = 10, .on_floor = true});
  EXPECT_GE(r.rejected, 2);
  EXPECT_EQ(map.landmark(a).sightings.size(), 3u);
  EXPECT_EQ(map.landmark(b).sightings.size(), 3u);
}

TEST(PlaceMatch, RecognisesAPlaceWithoutAnyIdeaOfThePose) {
  const Room room(200);
  const LandmarkMap map = room_map(room, kLine, kLine, 0.3, 0.005);
  const TPose2D truth{0.3, -0.2, 0.15};
  std::vector<int> points;
  const FeatureSet view = room.seen_from(from_planar(truth), 0.3, 0.005, 77, points);
  const std::vector<int> all = map.landmarks_of({0, 1, 2, 3});
  const PlaceMatch found = match_place(map, all, all, view, true, {.min_inliers = 30, .seed = 5});
  ASSERT_TRUE(found.accepted);
  const TPose2D pose = to_planar(found.solution.map_from_base);
  EXPECT_NEAR(pose.x, truth.x, 0.01);
  EXPECT_NEAR(pose.y, truth.y, 0.01);
  EXPECT_NEAR(pose.phi, truth.phi, 0.005);
}

TEST(PlaceMatch, ARoomThatLooksTheSameButIsBuiltOtherwiseIsRefused) {
  const Room room(200);
  const LandmarkMap map = room_map(room, kLine, kLine, 0.3, 0.005);
  Room shuffled = room;  // the same corners, each in another's place
  std::mt19937_64 random(3);
  std::shuffle(shuffled.where.begin(), shuffled.where.end(), random);
  std::vector<int> points;
  const FeatureSet view = shuffled.seen_from(from_planar({0.3, 0, 0}), 0.3, 0.005, 78, points);
  const std::vector<int> all = map.landmarks_of({0, 1, 2, 3});
  EXPECT_FALSE(match_place(map, all, all, view, true, {.min_inliers = 30, .seed = 5}).accepted);
}

TEST(LocalMap, FollowsWhatWasTracked) {
  const Room room(100);
  const LandmarkMap map = room_map(room, kLine, kLine, 0.0, 0.0);
  const LocalMap local = select_local_map(map, map.landmarks_of({2}), from_planar(kLine[2]));
  EXPECT_GE(local.reference_keyframe, 0);
  EXPECT_FALSE(local.landmarks.empty());
}

TEST(LocalMap, WithoutTrackedLandmarksTheNearestKeyframesServe) {
  const Room room(100);
  const LandmarkMap map = room_map(room, kLine, kLine, 0.0, 0.0);
  const LocalMap local = select_local_map(map, {}, from_planar(kLine[3]));
  EXPECT_EQ(local.reference_keyframe, 3);
}

TEST(LocalMap, AnEmptyMapGivesNothing) {
  const LandmarkMap map(SlamConfig{}, CameraModel(intrinsics()), forward_camera());
  EXPECT_EQ(select_local_map(map, {}, Se3{}).reference_keyframe, -1);
}

}  // namespace
}  // namespace rovigo::slam
