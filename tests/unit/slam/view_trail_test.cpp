#include "slam/view_trail.h"

#include <gtest/gtest.h>

#include "tests/support/landmark_room.h"

namespace rovigo::slam {
namespace {

using test::Room;

constexpr double kPixelNoise = 0.5, kDepthNoiseM = 0.005;

SeenView view_from(const Room& room, const TPose2D& truth, double time_s) {
  SeenView view;
  view.frame.time_s = time_s;
  std::vector<int> unused;
  view.features = room.seen_from(from_planar(truth), kPixelNoise, kDepthNoiseM,
                                 static_cast<std::uint64_t>(1000.0 * time_s), unused);
  return view;
}

/// What wheels say that count too much, or slip.
MotionPrediction predicted(const TPose2D& pose) {
  MotionPrediction out;
  out.prior.map_from_base = from_planar(pose);
  out.prior.information.diagonal() << 1e2, 1e2, 1e4, 1e4, 1e4, 1e3;
  out.covariance.diagonal() << 0.01, 0.01, 0.001;
  out.sigma_position_m = 0.14;
  out.sigma_heading_rad = 0.03;
  return out;
}

struct Trail : testing::Test {
  Room room{400};
  LandmarkMap saved{SlamConfig{}, CameraModel(test::intrinsics()), test::forward_camera()};
  ViewTrail trail{saved};
};

TEST_F(Trail, SaysNothingBeforeAnyView) {
  EXPECT_FALSE(trail.locate(view_from(room, {}, 1.0), predicted({})));
}

// The wheels are 5 % off; the views know better, and err by millimetres after three quarters of a
// metre.
TEST_F(Trail, MeasuresTheMotionThatWheelsGetWrong) {
  trail.keep(view_from(room, {}, 1.0), from_planar({}));
  TPose2D believed;
  for (int i = 1; i <= 50; ++i) {
    const TPose2D truth(0.015 * i, 0.0, 0.002 * i);
    const TPose2D wheels(believed.x + 1.05 * 0.015, believed.y, believed.phi + 0.002);
    const SeenView view = view_from(room, truth, 1.0 + i / 15.0);
    const auto seen = trail.locate(view, predicted(wheels));
    ASSERT_TRUE(seen) << "frame " << i;
    believed = to_planar(*seen);
    trail.keep(view, *seen);
    EXPECT_LT(maps::distance(maps::position_of(believed), maps::position_of(truth)), 0.01);
  }
}

TEST_F(Trail, MovesWithWhatIsLearnedOfThePlace) {
  trail.keep(view_from(room, {}, 1.0), from_planar({}));
  const TPose2D shift(0.3, -0.2, 0.1);
  trail.shift(from_planar(shift));
  const TPose2D truth(0.05, 0.0, 0.0);
  const TPose2D expected = maps::compose(shift, truth);
  const auto seen = trail.locate(view_from(room, truth, 1.1), predicted(expected));
  ASSERT_TRUE(seen);
  EXPECT_LT(maps::distance(maps::position_of(to_planar(*seen)), maps::position_of(expected)), 0.01);
}

TEST_F(Trail, DoesNotGoOnFromAnotherRoom) {
  trail.keep(view_from(room, {}, 1.0), from_planar({}));
  Room other{400};
  for (auto& d : other.look) {
    for (auto& word : d) word = ~word;
  }
  EXPECT_FALSE(trail.locate(view_from(other, {}, 1.1), predicted({})));
}

TEST_F(Trail, ForgetsWhenItIsCleared) {
  trail.keep(view_from(room, {}, 1.0), from_planar({}));
  trail.clear();
  EXPECT_FALSE(trail.locate(view_from(room, {}, 1.1), predicted({})));
}

}  // namespace
}  // namespace rovigo::slam
