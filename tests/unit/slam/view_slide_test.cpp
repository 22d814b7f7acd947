#include "slam/view_slide.h"

#include <gtest/gtest.h>

#include "tests/support/landmark_room.h"

namespace rovigo::slam {
namespace {

using namespace test;

constexpr double kPanelM = 0.9;
const std::vector<TPose2D> kAlong = {
    {0, -2.0, 0}, {0, -1.0, 0}, {0, 0, 0}, {0, 1.0, 0}, {0, 2.0, 0}};

/// A wall 3 m ahead, panelled: the same print every kPanelM.
Room panelled_wall() {
  const Room one(80);
  Room wall(0);
  for (int panel = -4; panel <= 4; ++panel) {
    for (std::size_t i = 0; i < one.where.size(); ++i) {
      Eigen::Vector3d p = one.where[i];
      p.y() = 0.3 * p.y() + panel * kPanelM;
      wall.where.push_back(p);
      wall.look.push_back(one.look[i]);
    }
  }
  return wall;
}

/// A wall as long on which nothing looks like anything else.
Room painted_wall() {
  Room wall(700);
  for (auto& p : wall.where) p.y() *= 3.0;
  return wall;
}

FeatureSet seen(const Room& room, const TPose2D& truth, std::uint64_t seed) {
  std::vector<int> points;
  return room.seen_from(from_planar(truth), 0.5, 0.01, seed, points);
}

/// The features of `spectrum` that speak for a shift of about `shift`.
int features_at(const SlideSpectrum& spectrum, const Eigen::Vector2d& shift) {
  int most = shift.norm() < ViewSlide::kHereM ? spectrum.here : 0;
  for (const Slide& s : spectrum.elsewhere) {
    if ((s.shift_map - shift).norm() < 0.05) most = std::max(most, s.features);
  }
  return most;
}

TEST(ViewSlide, APanelledWallFitsAPanelFurtherOnEitherSide) {
  const Room room = panelled_wall();
  const LandmarkMap map = room_map(room, kAlong, kAlong, 0.5, 0.01);
  const TPose2D truth{0.1, 0.05, 0.02};
  const SlideSpectrum spectrum = ViewSlide(map).around(seen(room, truth, 7), from_planar(truth));
  EXPECT_GT(spectrum.here, 60);
  EXPECT_GT(features_at(spectrum, {0.0, kPanelM}), 0.8 * spectrum.here);
  EXPECT_GT(features_at(spectrum, {0.0, -kPanelM}), 0.8 * spectrum.here);
}

TEST(ViewSlide, APlaceAPanelTooFarIsToldOfTheTrueOne) {
  const Room room = panelled_wall();
  const LandmarkMap map = room_map(room, kAlong, kAlong, 0.5, 0.01);
  const TPose2D truth{0.1, 0.05, 0.02}, wrong{0.1, 0.05 + kPanelM, 0.02};
  const SlideSpectrum spectrum = ViewSlide(map).around(seen(room, truth, 7), from_planar(wrong));
  EXPECT_GT(features_at(spectrum, {0.0, -kPanelM}), 0.8 * spectrum.best());
}

TEST(ViewSlide, AWallThatRepeatsNothingFitsNowhereElse) {
  const Room room = painted_wall();
  const LandmarkMap map = room_map(room, kAlong, kAlong, 0.5, 0.01);
  const TPose2D truth{0.1, 0.05, 0.02};
  const SlideSpectrum spectrum = ViewSlide(map).around(seen(room, truth, 7), from_planar(truth));
  EXPECT_GT(spectrum.here, 60);
  EXPECT_TRUE(spectrum.elsewhere.empty());
}

TEST(ViewSlide, AnErrorOfAnySizeWithinReachIsMeasuredToCentimetres) {
  const Room room = painted_wall();
  const LandmarkMap map = room_map(room, kAlong, kAlong, 0.5, 0.01);
  const ViewSlide slide(map);
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (std::uint64_t i = 1; i <= 30; ++i) {
    const TPose2D truth{0.4 * unit(random), unit(random), 0.2 * unit(random)};
    const Eigen::Vector2d error(2.0 * unit(random), 2.0 * unit(random));
    if (error.norm() < 0.2) continue;
    const TPose2D wrong{truth.x + error.x(), truth.y + error.y(), truth.phi};
    const SlideSpectrum spectrum = slide.around(seen(room, truth, i), from_planar(wrong));
    ASSERT_FALSE(spectrum.elsewhere.empty()) << "seed 31, case " << i;
    EXPECT_LT((spectrum.elsewhere[0].shift_map + error).norm(), 0.03) << "seed 31, case " << i;
    EXPECT_GT(spectrum.elsewhere[0].features, 3 * spectrum.here) << "seed 31, case " << i;
  }
}

TEST(ViewSlide, AViewWithoutDepthSaysNothing) {
  const Room room = painted_wall();
  const LandmarkMap map = room_map(room, kAlong, kAlong, 0.5, 0.01);
  const FeatureSet full = seen(room, {0, 0, 0}, 3);
  std::vector<Feature> features = full.features();
  for (Feature& f : features) f.depth_m = 0.0F;
  const FeatureSet blind(features, full.descriptors(), 640, 480);
  const SlideSpectrum spectrum = ViewSlide(map).around(blind, Se3{});
  EXPECT_EQ(spectrum.best(), 0);
}

}  // namespace
}  // namespace rovigo::slam
