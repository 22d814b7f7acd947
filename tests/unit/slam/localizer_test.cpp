#include "slam/localizer.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <random>

#include "slam/camera_frame.h"
#include "slam/features.h"
#include "tests/support/depth_room.h"
#include "tests/support/pinhole.h"

namespace rovigo::slam {
namespace {

using test::DepthRoom;

constexpr double kFrameS = 0.1;
constexpr double kMostFramesToBelieve = 60;

/// A map that knows walls and no features.
maps::SavedMap walls_only(const DepthRoom& room) {
  maps::SavedMap map;
  map.grid = room.grid();
  map.metadata.camera = test::pinhole(280.0, 320, 240);
  map.metadata.base_from_camera = to_mrpt(test::looking_ahead(0.25));
  return map;
}

Rig wheeled_rig() {
  Rig rig;
  rig.camera = test::pinhole(280.0, 320, 240);
  rig.base_from_camera = to_mrpt(test::looking_ahead(0.25));
  rig.has_extrinsics = rig.has_wheels = true;
  return rig;
}

/// Corners that look like nothing in any map.
FeatureSet strange_features(std::size_t number) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> u(10.0F, 310.0F), v(10.0F, 230.0F);
  std::vector<Feature> features(number);
  std::vector<Descriptor> descriptors(number);
  for (Feature& f : features) {
    f.pixel = {u(random), v(random)};
    f.depth_m = 2.0F;
  }
  for (Descriptor& d : descriptors) {
    for (auto& word : d) word = random();
  }
  return {std::move(features), std::move(descriptors), 320, 240};
}

/// A rover that stands in a room it was told to be in, and looks.
struct Watcher {
  Watcher(const DepthRoom& room, const TPose2D& at)
      : localizer(SlamConfig{}, wheeled_rig(), walls_only(room), PosePrior{at}) {
    for (int i = 0; i < kMostFramesToBelieve && last.health != Health::kOk; ++i) sees(room, at, 0);
  }
  /// One more frame; the wheels say that nothing moves.
  void sees(const DepthRoom& room, const TPose2D& at, std::size_t features) {
    time_s += kFrameS;
    mrpt::obs::CObservationOdometry wheels;
    wheels.timestamp = mrpt::Clock::fromDouble(time_s);
    localizer.process(wheels);
    CameraFrame frame = room.frame(time_s, at);
    frame.gray = cv::Mat(240, 320, CV_8UC1, cv::Scalar(128));
    last = localizer.process(frame, strange_features(features));
  }
  /// Seconds until it says LOST, at most `most_s`.
  double lost_after_s(const DepthRoom& room, const TPose2D& at, std::size_t features,
                      double most_s) {
    const double from_s = time_s;
    while (time_s - from_s < most_s) {
      sees(room, at, features);
      if (last.health == Health::kLost) break;
    }
    return time_s - from_s;
  }

  Localizer localizer;
  PoseEstimate last;
  double time_s = 100.0;
};

constexpr double kPatienceS = 3.0;
const TPose2D kStart{1.2, 2.0, 0.3};

TEST(Localizer, WallsAloneHoldAPlaceItWasTold) {
  const DepthRoom room = test::odd_room();
  Watcher watcher(room, kStart);
  EXPECT_NE(watcher.last.health, Health::kLost);
  for (int i = 0; i < 30; ++i) watcher.sees(room, kStart, 0);
  EXPECT_NEAR(watcher.last.map_from_base.x(), kStart.x, 0.2);
  EXPECT_NEAR(watcher.last.map_from_base.y(), kStart.y, 0.2);
  EXPECT_NE(watcher.last.health, Health::kLost);
}

/// A hall with pillars along one wall, all alike.
DepthRoom pillared_hall() {
  constexpr double kEveryM = 0.8, kDeepM = 0.25, kWideM = 0.2;
  std::vector<test::WallSegment> walls = {
      {{0, 0}, {12, 0}}, {{12, 0}, {12, 9}}, {{12, 9}, {0, 9}}, {{0, 9}, {0, 0}}};
  for (double x = kEveryM; x < 11.5; x += kEveryM) {
    walls.push_back({{x, 0}, {x, kDeepM}});
    walls.push_back({{x, kDeepM}, {x + kWideM, kDeepM}});
    walls.push_back({{x + kWideM, kDeepM}, {x + kWideM, 0}});
  }
  return DepthRoom(walls);
}

// What stands around fits as well a pillar further: that is no reason to leave the place that
// somebody has named.
TEST(Localizer, StaysWhereItWasToldThoughWallsFitElsewhereToo) {
  const DepthRoom hall = pillared_hall();
  for (const double x : {4.3, 5.0, 6.6, 7.1}) {
    const TPose2D start{x, 1.6, -1.4};
    Watcher watcher(hall, start);
    for (int i = 0; i < 20; ++i) watcher.sees(hall, start, 400);
    EXPECT_NEAR(watcher.last.map_from_base.x(), start.x, 0.05);
    EXPECT_NEAR(watcher.last.map_from_base.y(), start.y, 0.05);
    EXPECT_NE(watcher.last.health, Health::kLost);
  }
}

// Carried before a blank wall: few features, which is no contradiction; walls elsewhere are.
TEST(Localizer, IsLostSoonWhereWallsContradictThoughTheViewShowsNoFeatures) {
  const DepthRoom room = test::odd_room();
  Watcher watcher(room, kStart);
  ASSERT_NE(watcher.last.health, Health::kLost);
  EXPECT_LE(watcher.lost_after_s(room, {5.0, 1.0, -2.0}, 0, kPatienceS), 0.6);
}

// Carried to where the map knows nothing: nothing contradicts the old place, nothing vouches for
// it.
TEST(Localizer, IsLostWithinASecondWhereAfterAJumpNothingFits) {
  const DepthRoom room = test::odd_room();
  const DepthRoom hall(
      {{{-9, -9}, {14, -9}}, {{14, -9}, {14, 13}}, {{14, 13}, {-9, 13}}, {{-9, 13}, {-9, -9}}});
  Watcher watcher(room, kStart);
  ASSERT_NE(watcher.last.health, Health::kLost);
  EXPECT_LE(watcher.lost_after_s(hall, kStart, 400, kPatienceS), 1.0 + 1e-6);
}

// A covered lens shows as little: the rover stands where it stood, and will see so.
TEST(Localizer, IsNotLostForALookThatShowsNothing) {
  const DepthRoom room = test::odd_room();
  const DepthRoom hall(
      {{{-9, -9}, {14, -9}}, {{14, -9}, {14, 13}}, {{14, 13}, {-9, 13}}, {{-9, 13}, {-9, -9}}});
  Watcher watcher(room, kStart);
  EXPECT_GE(watcher.lost_after_s(hall, kStart, 20, kPatienceS), kPatienceS);
}

}  // namespace
}  // namespace rovigo::slam
