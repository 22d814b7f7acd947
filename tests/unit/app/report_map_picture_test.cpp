#include "app/report/map_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "maps/error.h"

namespace rovigo::app {
namespace {

using maps::OccupancyGrid;

OccupancyGrid room(int width, int height, double resolution = 0.05) {
  OccupancyGrid grid({resolution, {-1, -2}, width, height}, OccupancyGrid::kFree);
  for (int x = 0; x < width; ++x) grid.at({x, 0}) = grid.at({x, height - 1}) = 100;
  for (int y = 0; y < height; ++y) grid.at({0, y}) = grid.at({width - 1, y}) = 100;
  return grid;
}

cv::Mat decoded(const std::string& png) {
  const std::vector<uchar> bytes(png.begin(), png.end());
  return cv::imdecode(bytes, cv::IMREAD_COLOR);
}

/// How many pixels have about this colour (blue, green, red).
int pixels_like(const cv::Mat& image, const cv::Scalar& color) {
  cv::Mat mask;
  cv::inRange(image, color - cv::Scalar(12, 12, 12), color + cv::Scalar(12, 12, 12), mask);
  return cv::countNonZero(mask);
}

const cv::Scalar kPlanned(178, 114, 0), kDriven(0, 94, 213), kLethal(205, 225, 250);

TEST(MapPicture, LongerSideIsWithinBounds) {
  const int sizes[][2] = {{3, 2}, {50, 400}, {640, 100}, {799, 10}, {1500, 900}, {5000, 3000}};
  for (const auto& [w, h] : sizes) {
    const cv::Mat image = decoded(map_picture_png(room(w, h), {}));
    const int longer = std::max(image.cols, image.rows);
    EXPECT_GE(longer, 800) << w << " x " << h;
    EXPECT_LE(longer, 1600 + 200) << w << " x " << h;  // legend and border come on top
  }
}

TEST(MapPicture, SameInputSameBytes) {
  MapPictureLayers layers;
  layers.planned_path = {{0, 0}, {1, 1}};
  EXPECT_EQ(map_picture_png(room(100, 80), layers), map_picture_png(room(100, 80), layers));
}

TEST(MapPicture, DrawsThePathsItIsGivenAndNoOthers) {
  MapPictureLayers layers;
  layers.planned_path = {{0, 0}, {3, 0}};
  const cv::Mat planned_only = decoded(map_picture_png(room(100, 80), layers));
  EXPECT_GT(pixels_like(planned_only, kPlanned), 500);
  EXPECT_EQ(pixels_like(planned_only, kDriven), 0);
  layers.driven_path = {{0, 0.5}, {3, 0.5}};
  EXPECT_GT(pixels_like(decoded(map_picture_png(room(100, 80), layers)), kDriven), 300);
}

TEST(MapPicture, UpIsUp) {
  OccupancyGrid grid = room(100, 100);
  for (int x = 10; x < 90; ++x) grid.at({x, 90}) = 100;  // a wall near the top
  const cv::Mat image = decoded(map_picture_png(grid, {}));
  cv::Mat dark;
  cv::inRange(image, cv::Scalar(0, 0, 0), cv::Scalar(70, 70, 70), dark);
  const int half = image.rows * 45 / 100;
  EXPECT_GT(cv::countNonZero(dark.rowRange(0, half)),
            cv::countNonZero(dark.rowRange(half, image.rows)) + 2000);
}

TEST(MapPicture, ShrinkingLosesNoObstacle) {
  OccupancyGrid grid({0.05, {0, 0}, 6000, 4000}, OccupancyGrid::kFree);
  const int before = pixels_like(decoded(map_picture_png(grid, {})), {48, 42, 38});
  grid.at({3000, 2000}) = 100;
  EXPECT_GT(pixels_like(decoded(map_picture_png(grid, {})), {48, 42, 38}), before);
}

TEST(MapPicture, TintsTheLethalBand) {
  const OccupancyGrid grid = room(100, 80);
  MapPictureLayers layers;
  layers.costmap.emplace(grid.geometry);
  for (int y = 20; y < 40; ++y) {
    for (int x = 20; x < 40; ++x) layers.costmap->at({x, y}) = maps::Costmap::kLethal;
  }
  EXPECT_GT(pixels_like(decoded(map_picture_png(grid, layers)), kLethal), 10000);
}

TEST(MapPicture, CropsToTheKnownArea) {
  OccupancyGrid grid({0.05, {0, 0}, 2000, 2000});
  for (int y = 1000; y < 1040; ++y) {
    for (int x = 1000; x < 1080; ++x) grid.at({x, y}) = OccupancyGrid::kFree;
  }
  const cv::Mat image = decoded(map_picture_png(grid, {}));
  EXPECT_GT(image.cols, image.rows);  // 4 x 2 m, not 100 x 100
  EXPECT_GT(pixels_like(image, {252, 252, 252}), image.cols * image.rows / 4);
}

TEST(MapPicture, WildPointsNeitherCrashNorShrinkTheMap) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  MapPictureLayers layers;
  layers.driven_path = {{0, 0}, {kNan, 1}, {1e12, -1e12}, {1, 1}};
  layers.estimated_path = {{-1e300, std::numeric_limits<double>::infinity()}};
  layers.via_points = {{kNan, kNan}};
  layers.start = TPose2D(kNan, 0, 0);
  layers.goal = TPose2D(0, 0, kNan);
  layers.keyframes = {{0, kNan, 0}};
  const cv::Mat image = decoded(map_picture_png(room(100, 80), layers));
  EXPECT_LE(image.cols, 1700);
  EXPECT_GT(pixels_like(image, {252, 252, 252}), image.cols * image.rows / 3);
}

TEST(MapPicture, AMapWithNothingKnownIsDrawnAndAnEmptyOneRefused) {
  EXPECT_NO_THROW(map_picture_png(OccupancyGrid({0.05, {0, 0}, 20, 20}), {}));
  EXPECT_THROW(map_picture_png(OccupancyGrid(), {}), maps::InputError);
  OccupancyGrid broken = room(10, 10);
  broken.cells.pop_back();
  EXPECT_THROW(map_picture_png(broken, {}), maps::InputError);
}

TEST(MapPicture, LongTitlesAndManyLayersFit) {
  MapPictureLayers layers;
  layers.title = std::string(500, 'W');
  layers.planned_path = layers.driven_path = layers.estimated_path = {{0, 0}, {1, 1}};
  layers.start = layers.goal = TPose2D(0.5, 0.5, 1);
  layers.via_points = {{0.2, 0.2}};
  layers.keyframes = {{0.1, 0.1, 0}};
  EXPECT_FALSE(decoded(map_picture_png(room(16, 400), layers)).empty());
}

}  // namespace
}  // namespace rovigo::app
