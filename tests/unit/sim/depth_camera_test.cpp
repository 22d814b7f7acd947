// The camera against closed form: a flat wall straight ahead.

#include "sim/depth_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "test_worlds.h"

namespace rovigo::sim {
namespace {

using mrpt::obs::CObservation3DRangeScan;

constexpr double kCameraForwardM = 0.12;

CObservation3DRangeScan::Ptr first_frame(const World& world, const Scenario& scenario,
                                         std::uint64_t seed = 1, const TPose2D& pose = {}) {
  SimulatorOptions options;
  options.scenario = scenario;
  options.seed = seed;
  options.world_from_base = pose;
  Simulator simulator(world, options);
  return only<CObservation3DRangeScan>(simulator.take_observations()).front();
}

cv::Mat color_of(const CObservation3DRangeScan& frame) {
  return frame.intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
}

TEST(DepthCamera, APerfectOneMeasuresAWallToTheMillimetreInEveryPixel) {
  const auto frame = first_frame(World(wall_ahead(2.0)), ideal_scenario());
  ASSERT_TRUE(frame->hasRangeImage);
  EXPECT_TRUE(frame->range_is_depth);
  EXPECT_FLOAT_EQ(frame->rangeUnits, 0.001F);
  EXPECT_EQ(frame->sensorLabel, "camera");
  for (int y = 0; y < 300; y += 7) {  // the rows above the floor's
    for (int x = 0; x < 640; x += 7) {
      EXPECT_NEAR(frame->rangeImage(y, x), 1000 * (2.0 - kCameraForwardM), 2.0) << x << ", " << y;
    }
  }
}

TEST(DepthCamera, TheFloorLiesWhereGeometryPutsIt) {
  const auto frame = first_frame(World(bare_floor()), ideal_scenario());
  for (int y = 330; y < 480; y += 10) {
    const double depth = 0.25 * 460.0 / (y - 239.5);  // camera height * focal length / row
    EXPECT_NEAR(frame->rangeImage(y, 320), 1000 * depth, 3.0 + 4.0 * depth) << "row " << y;
  }
}

class DepthNoise : public testing::TestWithParam<double> {};

TEST_P(DepthNoise, GrowsWithTheSquareOfDepthAsItsFigureSays) {
  const double depth = GetParam();
  Scenario scenario;
  scenario.camera.edge_raggedness_px = 0.0;
  const auto frame = first_frame(World(wall_ahead(depth + kCameraForwardM)), scenario);
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  for (int y = 60; y < 235; ++y) {
    for (int x = 20; x < 620; ++x) {
      if (frame->rangeImage(y, x) == 0) continue;
      const double error = 0.001 * frame->rangeImage(y, x) - depth;
      sum += error;
      squares += error * error;
      ++count;
    }
  }
  ASSERT_GT(count, 50000);
  const double sigma = std::sqrt(squares / count - std::pow(sum / count, 2));
  // White noise and the disparity's rounding together.
  const CameraNoise figures;
  const double quantum = figures.disparity_quantum_px / (460.0 * figures.baseline_m);
  const double expected =
      depth * depth * std::hypot(figures.depth_sigma_per_m, quantum / std::sqrt(12.0));
  EXPECT_NEAR(sigma, expected, 0.06 * expected + 0.0003);
  EXPECT_NEAR(sum / count, 0.0, 0.25 * expected + 0.001) << "no bias to speak of";
}

INSTANTIATE_TEST_SUITE_P(Depths, DepthNoise, testing::Values(0.8, 1.5, 3.0, 5.0));

TEST(DepthCamera, SeesNothingBeyondItsRangeNorNearerThanIt) {
  const auto far = first_frame(World(wall_ahead(6.5)), ideal_scenario());
  EXPECT_EQ(far->rangeImage(100, 320), 0);
  const auto near = first_frame(World(wall_ahead(0.40)), ideal_scenario());
  EXPECT_EQ(near->rangeImage(100, 320), 0) << "the wall is 0.28 m from the camera";
}

TEST(DepthCamera, HasNoReturnFromSurfacesSeenAtAGrazingAngle) {
  const auto frame = first_frame(World(bare_floor()), ideal_scenario());
  // The floor is met at 80 degrees of incidence where depth = height * tan(80 deg) straight ahead.
  const double limit_row = 239.5 + 460.0 / std::tan(80.0 * maps::kPi / 180.0);
  EXPECT_EQ(frame->rangeImage(static_cast<int>(limit_row) - 3, 320), 0);
  EXPECT_NE(frame->rangeImage(static_cast<int>(limit_row) + 3, 320), 0);
}

TEST(DepthCamera, TearsEdgesOnlyAtEdges) {
  WorldModel model = wall_ahead(4.0);
  model.solids.push_back(box_at(1.5, 0.0, 0.0, {0.2, 0.6, 2.0}));
  Scenario scenario = ideal_scenario();
  scenario.camera.edge_raggedness_px = 2.0;
  const auto torn = first_frame(World(model), scenario);
  const auto clean = first_frame(World(model), ideal_scenario());
  int changed = 0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 2; x < 638; ++x) {
      if (std::abs(int{torn->rangeImage(y, x)} - int{clean->rangeImage(y, x)}) < 50) continue;
      ++changed;
      bool near_edge = false;
      for (int d = -2; d <= 2; ++d) {
        const int other = clean->rangeImage(y, std::clamp(x + d, 0, 639));
        near_edge = near_edge || std::abs(other - int{clean->rangeImage(y, x)}) > 500;
      }
      EXPECT_TRUE(near_edge) << x << ", " << y;
    }
  }
  EXPECT_GT(changed, 200);
}

TEST(DepthCamera, UnprojectsToTheWallInTheRoversFrame) {
  const auto frame = first_frame(World(wall_ahead(2.0)), ideal_scenario());
  mrpt::obs::T3DPointsProjectionParams params;
  params.takeIntoAccountSensorPoseOnRobot = true;
  CObservation3DRangeScan points = *frame;
  points.unprojectInto(points, params);
  ASSERT_GT(points.points3D_x.size(), 100000U);
  int on_wall = 0;
  for (std::size_t i = 0; i < points.points3D_x.size(); i += 101) {
    const float x = points.points3D_x[i];
    const float y = points.points3D_y[i];
    const float z = points.points3D_z[i];
    const bool wall = std::abs(x - 2.0F) < 0.01F;
    const bool floor = std::abs(z) < 0.02F;
    EXPECT_TRUE(wall || floor) << x << ", " << y << ", " << z;
    on_wall += wall ? 1 : 0;
  }
  EXPECT_GT(on_wall, 500);
}

TEST(DepthCamera, TextureMovesExactlyWithTheSurface) {
  // Two views of one poster from different distances: where geometry maps a pixel of the one view
  // into the other, both must show the same grey.
  WorldModel model = wall_ahead(3.0);
  model.solids.back().material = {{0.8F, 0.8F, 0.8F}, Pattern::kPoster, 5};
  const World world(model);
  const auto far = first_frame(world, ideal_scenario());
  const auto near = first_frame(world, ideal_scenario(), 1, {0.6, 0.0, 0.0});
  cv::Mat far_image = color_of(*far);
  cv::Mat near_image = color_of(*near);
  const double ratio = (3.0 - kCameraForwardM) / (3.0 - kCameraForwardM - 0.6);
  double difference = 0.0;
  double contrast = 0.0;
  int count = 0;
  for (int y = 60; y < 230; ++y) {
    for (int x = 80; x < 560; ++x) {
      const int u = static_cast<int>(std::lround(319.5 + (x - 319.5) * ratio));
      const int v = static_cast<int>(std::lround(239.5 + (y - 239.5) * ratio));
      if (u < 0 || v < 0 || u >= 640 || v >= 480) continue;
      difference += std::abs(far_image.at<cv::Vec3b>(y, x)[1] - near_image.at<cv::Vec3b>(v, u)[1]);
      contrast += std::abs(far_image.at<cv::Vec3b>(y, x)[1] -
                           near_image.at<cv::Vec3b>(std::max(0, v - 30), u)[1]);
      ++count;
    }
  }
  ASSERT_GT(count, 30000);
  EXPECT_LT(difference / count, 0.25 * contrast / count);
}

TEST(DepthCamera, APlainSurfaceGivesNoTexture) {
  const auto frame = first_frame(World(wall_ahead(2.0)), ideal_scenario());
  const cv::Mat wall = color_of(*frame)(cv::Rect(50, 20, 540, 200));
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(wall, mean, sigma);
  EXPECT_LT(sigma[1], 0.5);
}

TEST(DepthCamera, ColourNoiseHasItsFigure) {
  Scenario scenario = ideal_scenario();
  scenario.camera.color_noise_levels = 4.0;
  const auto frame = first_frame(World(wall_ahead(2.0)), scenario);
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(color_of(*frame)(cv::Rect(50, 20, 540, 200)), mean, sigma);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sigma[c], 4.0, 0.2);
}

TEST(DepthCamera, OneSeedGivesOneImageAndAnotherSeedAnother) {
  const World world(wall_ahead(2.0));
  const auto a = first_frame(world, Scenario{}, 7);
  const auto b = first_frame(world, Scenario{}, 7);
  const auto c = first_frame(world, Scenario{}, 8);
  EXPECT_EQ(a->rangeImage, b->rangeImage);
  EXPECT_EQ(cv::norm(color_of(*a), color_of(*b)), 0.0);
  EXPECT_NE(a->rangeImage, c->rangeImage);
}

TEST(DepthCamera, TheNumberOfThreadsDoesNotChangeABit) {
  WorldModel model = wall_ahead(2.0);
  model.solids.back().material.pattern = Pattern::kBricks;
  model.solids.front().material.pattern = Pattern::kTiles;
  const Renderer renderer(model);
  mrpt::img::TCamera camera;
  camera.ncols = 320;
  camera.nrows = 240;
  camera.setIntrinsicParamsFromValues(230, 230, 159.5, 119.5);
  const mrpt::poses::CPose3D pose(0.0, 0.0, 0.25, -1.4, 0.1, -1.6);
  View one;
  View three;
  renderer.render({.world_from_camera = pose, .camera = camera, .threads = 1}, one);
  renderer.render({.world_from_camera = pose, .camera = camera, .threads = 3}, three);
  EXPECT_EQ(one.depth_m, three.depth_m);
  EXPECT_EQ(one.bgr, three.bgr);
}

TEST(DepthCamera, LightStepsDarkenTheImageAndExposureBringsItBack) {
  WorldModel model = wall_ahead(2.0);
  Scenario scenario;
  scenario.light_steps.push_back({.time_s = 0.5, .factor = 0.35});
  SimulatorOptions options;
  options.scenario = scenario;
  options.camera_rate_hz = 10.0;
  Simulator simulator((World(model)), options);
  drive(simulator, {}, 3.0);
  const auto frames = only<CObservation3DRangeScan>(simulator.take_observations());
  const auto brightness = [&](std::size_t i) { return cv::mean(color_of(*frames[i]))[1]; };
  EXPECT_LT(brightness(5), 0.6 * brightness(4));
  EXPECT_NEAR(brightness(frames.size() - 1), brightness(4), 0.1 * brightness(4));
}

TEST(DepthCamera, BlackoutsDropFramesOrCoverThem) {
  Scenario scenario;
  scenario.blackouts.push_back({.start_s = 0.45, .duration_s = 0.5, .kind = "missing"});
  scenario.blackouts.push_back({.start_s = 1.45, .duration_s = 0.5, .kind = "covered"});
  SimulatorOptions options;
  options.scenario = scenario;
  options.camera_rate_hz = 10.0;
  Simulator simulator(World(wall_ahead(2.0)), options);
  drive(simulator, {}, 2.5);
  const auto frames = only<CObservation3DRangeScan>(simulator.take_observations());
  EXPECT_EQ(frames.size(), 26U - 5U);
  int dark = 0;
  for (const auto& frame : frames) {
    if (cv::mean(color_of(*frame))[1] > 10.0) continue;
    ++dark;
    EXPECT_EQ(frame->rangeImage(100, 320), 0);
  }
  EXPECT_EQ(dark, 5);
}

TEST(DepthCamera, TurningBlursAcross) {
  WorldModel model = wall_ahead(2.0);
  model.solids.back().material = {{0.8F, 0.8F, 0.8F}, Pattern::kNoise, 3};
  Scenario sharp = ideal_scenario();
  Scenario blurred = ideal_scenario();
  blurred.camera.exposure_s = 0.015;
  const auto gradient = [&](const Scenario& scenario) {
    SimulatorOptions options;
    options.scenario = scenario;
    Simulator simulator(World(model), options);
    drive(simulator, {0.0, 0.0, 1.0}, 0.5);
    const auto frames = only<CObservation3DRangeScan>(simulator.take_observations());
    const cv::Mat image = color_of(*frames.back());
    double sum = 0.0;
    for (int y = 0; y < 200; ++y) {
      for (int x = 1; x < 640; ++x) {
        sum += std::abs(image.at<cv::Vec3b>(y, x)[1] - image.at<cv::Vec3b>(y, x - 1)[1]);
      }
    }
    return sum;
  };
  EXPECT_LT(gradient(blurred), 0.7 * gradient(sharp));
}

}  // namespace
}  // namespace rovigo::sim
