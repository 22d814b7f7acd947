#include "sim/glossy_floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core/mat.hpp>

#include "test_worlds.h"

namespace rovigo::sim {
namespace {

constexpr double kCameraM = 0.25;

mrpt::obs::CObservation3DRangeScan::Ptr first_frame(const WorldModel& model, double mirror,
                                                    std::uint64_t seed = 1) {
  SimulatorOptions options;
  options.scenario = ideal_scenario();
  options.scenario.floor.mirror = mirror;
  options.seed = seed;
  Simulator simulator{World(model), options};
  return only<mrpt::obs::CObservation3DRangeScan>(simulator.take_observations()).front();
}

/// Shares of the floor's pixels before a wall at 2 m, by what the depth camera says of them.
struct FloorReadings {
  int pixels = 0;
  int below = 0;  ///< clearly under the floor
  int lost = 0;
  int above = 0;  ///< more than 5 cm over the floor: would be an obstacle
  int off = 0;    ///< by more than 1 cm
};

FloorReadings read_floor(const mrpt::obs::CObservation3DRangeScan& scan) {
  FloorReadings out;
  for (int y = 350; y < 480; ++y) {
    const double slope = (y - 239.5) / 460.0;
    for (int x = 0; x < 640; ++x) {
      const double z = 0.001 * scan.rangeImage(y, x);
      const double height = kCameraM - z * slope;
      ++out.pixels;
      out.lost += z == 0.0;
      out.below += z > 0.0 && height < -0.05;
      out.above += z > 0.0 && height > 0.05;
      out.off += z > 0.0 && std::abs(z - kCameraM / slope) > 0.01;
    }
  }
  return out;
}

TEST(GlossyFloor, AMattFloorReadsItsOwnDepthEverywhere) {
  const auto r = read_floor(*first_frame(wall_ahead(2.0), 0.0));
  EXPECT_EQ(r.below, 0);
  EXPECT_EQ(r.above, 0);
  EXPECT_EQ(r.lost, 0);
  EXPECT_EQ(r.off, 0);
}

TEST(GlossyFloor, InPatchesReadsTheMirrorImageBelowItOrNothingButNoObstacle) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto r = read_floor(*first_frame(wall_ahead(2.0), 0.8, seed));
    EXPECT_GT(r.below, 0.03 * r.pixels);
    EXPECT_LT(r.below, 0.45 * r.pixels);
    EXPECT_GT(r.lost, 0.03 * r.pixels);
    EXPECT_LT(r.lost, 0.45 * r.pixels);
    EXPECT_GT(r.off, 0.2 * r.pixels);
    EXPECT_EQ(r.above, 0) << "noise of centimetres along a shallow ray lifts nothing by 5 cm";
  }
}

TEST(GlossyFloor, TheMirrorImagesDepthIsThatOfTheMirroredPoint) {
  // A wall whose foot stands 2 m ahead: its image below the floor is a wall at the same depth.
  const auto scan = first_frame(wall_ahead(2.0), 0.8);
  int on_wall = 0;
  for (int y = 350; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      const double z = 0.001 * scan->rangeImage(y, x);
      const double height = kCameraM - z * (y - 239.5) / 460.0;
      if (z == 0.0 || height > -0.25) continue;
      EXPECT_NEAR(z, 2.0 - 0.12, 0.01);
      ++on_wall;
    }
  }
  EXPECT_GT(on_wall, 1000);
}

TEST(GlossyFloor, ShowsTheColourOfWhatItMirrorsAndMoreOfItWhereTheViewIsShallow) {
  WorldModel model = wall_ahead(2.0);
  model.solids[0].material.color = {0.5F, 0.5F, 0.5F};
  model.solids[1].material.color = {1.0F, 0.0F, 0.0F};
  const auto redness = [&](double mirror, int y) {
    const cv::Mat image = first_frame(model, mirror)->intensityImage.asCvMatRef();
    const auto& p = image.at<cv::Vec3b>(y, 320);
    return p[2] / (p[1] + 1.0);
  };
  EXPECT_NEAR(redness(0.0, 320), 1.0, 0.05);
  EXPECT_GT(redness(1.0, 320), 1.3);
  EXPECT_GT(redness(1.0, 320), redness(1.0, 470) + 0.1);
}

TEST(GlossyFloor, IsNoObstacleInTheTruth) {
  const auto grid = true_grid(World::random_office(4), 0.05, 0.05, 0.50);
  EXPECT_TRUE(maps::OccupancyGrid::is_free(
      grid.at(grid.geometry.cell_at(maps::position_of(World::random_office(4).start())))));
}

}  // namespace
}  // namespace rovigo::sim
