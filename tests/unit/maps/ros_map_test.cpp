#include "maps/ros_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "maps/error.h"
#include "tests/unit/maps/test_support.h"

namespace rovigo::maps {
namespace {

using test::bytes_of;
using test::put_bytes;
using test::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;

std::string yaml(const std::string& more = "", const std::string& image = "map.pgm") {
  return "image: " + image +
         "\nresolution: 0.05\norigin: [-1.5, 2.25, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n"
         "free_thresh: 0.196\n" +
         more;
}

/// A 4 x 2 map with the given pixel values, top row first.
OccupancyGrid load(const std::string& yaml_text, const std::string& image,
                   std::vector<std::string>* warnings = nullptr) {
  const ScratchFolder folder;
  put_bytes(folder / "map.yaml", yaml_text);
  put_bytes(folder / "map.pgm", image);
  std::vector<std::string> ignored;
  return load_ros_map(folder / "map.yaml", warnings ? *warnings : ignored);
}

std::string pgm(const std::vector<int>& values, int width = 4) {
  std::string bytes = "P5\n# made by hand\n" + std::to_string(width) + " " +
                      std::to_string(values.size() / static_cast<std::size_t>(width)) + "\n255\n";
  for (const int v : values) bytes += static_cast<char>(v);
  return bytes;
}

std::string refusal(const std::string& yaml_text, const std::string& image) {
  try {
    load(yaml_text, image);
  } catch (const InputError& e) {
    return e.what();
  }
  return "loaded";
}

TEST(RosMap, ReadsTrinaryWithTheLowerLeftCellFirst) {
  const OccupancyGrid grid = load(yaml(), pgm({254, 205, 0, 255, 0, 0, 254, 254}));
  EXPECT_EQ(grid.geometry.width, 4);
  EXPECT_EQ(grid.geometry.height, 2);
  EXPECT_EQ(grid.geometry.origin.x, -1.5);
  EXPECT_EQ(grid.geometry.origin.y, 2.25);
  EXPECT_THAT(grid.cells, ElementsAre(100, 100, 0, 0, 0, -1, 100, 0));
}

TEST(RosMap, NegateTurnsBlackIntoFree) {
  std::string text = yaml();
  text.replace(text.find("negate: 0"), 9, "negate: 1");
  EXPECT_THAT(load(text, pgm({0, 255, 120, 0}, 4)).cells, ElementsAre(0, 100, -1, 0));
}

TEST(RosMap, ScaleKeepsWhatLiesBetweenTheThresholds) {
  const auto cells = load(yaml("mode: scale\n"), pgm({255, 0, 150, 205}, 4)).cells;
  // p = 105/255 = 0.4118: (0.4118 - 0.196) / 0.454 = 47.5%; p = 50/255: 0.0%.
  EXPECT_THAT(cells, ElementsAre(0, 100, 48, 0));
}

TEST(RosMap, RawKeepsTheValueItself) {
  const auto cells = load(yaml("mode: raw\n"), pgm({0, 37, 100, 101}, 4)).cells;
  EXPECT_THAT(cells, ElementsAre(0, 37, 100, -1));
}

TEST(RosMap, TransparentPixelsAreUnknownInScaleMode) {
  const ScratchFolder folder;
  cv::Mat image(1, 3, CV_8UC4, cv::Scalar(255, 255, 255, 255));
  image.at<cv::Vec4b>(0, 1) = {0, 0, 0, 255};
  image.at<cv::Vec4b>(0, 2) = {255, 255, 255, 90};
  cv::imwrite(folder / "map.png", image);
  put_bytes(folder / "map.yaml", yaml("mode: scale\n", "map.png"));
  std::vector<std::string> warnings;
  EXPECT_THAT(load_ros_map(folder / "map.yaml", warnings).cells, ElementsAre(0, 100, -1));
}

TEST(RosMap, SixteenBitImagesMeanTheSame) {
  const std::string header = "P5 2 1 65535\n";
  EXPECT_THAT(load(yaml(), header + std::string("\xff\xff\x00\x00", 4)).cells, ElementsAre(0, 100));
  const ScratchFolder folder;
  cv::Mat image(1, 2, CV_16UC1, cv::Scalar(65535));
  image.at<std::uint16_t>(0, 1) = 0;
  cv::imwrite(folder / "map.png", image);
  put_bytes(folder / "map.yaml", yaml("", "map.png"));
  std::vector<std::string> warnings;
  EXPECT_THAT(load_ros_map(folder / "map.yaml", warnings).cells, ElementsAre(0, 100));
}

TEST(RosMap, OtherLargestValuesAndTextPgmsAreRead) {
  EXPECT_THAT(load(yaml(), "P2\n# c\n3 # width\n1\n# c\n15\n15 0 12\n").cells,
              ElementsAre(0, 100, -1));
}

TEST(RosMap, WarnsWhenUnknownBecomesFree) {
  std::string text = yaml();
  text.replace(text.find("0.196"), 5, "0.25");
  std::vector<std::string> warnings;
  EXPECT_THAT(load(text, pgm({205, 254, 0, 0}), &warnings).cells, ElementsAre(0, 0, 100, 100));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("free_thresh 0.25"));
  warnings.clear();
  load(yaml(), pgm({205, 254, 0, 0}), &warnings);
  EXPECT_TRUE(warnings.empty());
}

TEST(RosMap, ColoursAreAveraged) {
  const ScratchFolder folder;
  cv::imwrite(folder / "map.png", cv::Mat(1, 1, CV_8UC3, cv::Scalar(0, 0, 90)));  // p = 0.88
  put_bytes(folder / "map.yaml", yaml("", "map.png"));
  std::vector<std::string> warnings;
  EXPECT_THAT(load_ros_map(folder / "map.yaml", warnings).cells, ElementsAre(100));
}

TEST(RosMap, TurnedMapIsRefused) {
  std::string text = yaml();
  text.replace(text.find("0.0]"), 3, "0.3");
  EXPECT_THAT(refusal(text, pgm({0, 0, 0, 0})), HasSubstr("origin yaw"));
}

TEST(RosMap, BadYamlIsNamedWithKeyAndValue) {
  const std::string image = pgm({0, 0, 0, 0});
  const auto with = [&](const std::string& old, const std::string& text) {
    std::string y = yaml();
    y.replace(y.find(old), old.size(), text);
    return refusal(y, image);
  };
  EXPECT_THAT(with("resolution: 0.05\n", ""), HasSubstr("resolution is missing"));
  EXPECT_THAT(with("0.05", "nan"), HasSubstr("resolution = \"nan\""));
  EXPECT_THAT(with("0.05", "-1"), HasSubstr("resolution"));
  EXPECT_THAT(with("-1.5", ".inf"), HasSubstr("origin x"));
  EXPECT_THAT(with("[-1.5, 2.25, 0.0]", "[1, 2]"), HasSubstr("origin"));
  EXPECT_THAT(with("negate: 0", "negate: maybe"), HasSubstr("negate"));
  EXPECT_THAT(with("0.196", "0.7"), HasSubstr("below occupied_thresh"));
  EXPECT_THAT(refusal(yaml("mode: fancy\n"), image), HasSubstr("fancy"));
  EXPECT_THAT(refusal("{a: [", image), HasSubstr("YAML"));
  EXPECT_THAT(refusal("just text", image), HasSubstr("no ROS map"));
  EXPECT_THAT(refusal("", image), HasSubstr("no ROS map"));
}

TEST(RosMap, BadImagesAreNamed) {
  EXPECT_THAT(refusal(yaml(), ""), HasSubstr("empty"));
  EXPECT_THAT(refusal(yaml(), "P5 4 4 255\nxyz"), HasSubstr("cut off"));
  EXPECT_THAT(refusal(yaml(), "P5 2000000 2000000 255\nxyz"), HasSubstr("claims 2000000"));
  EXPECT_THAT(refusal(yaml(), "P5 99999999999999999999 1 255\nx"), HasSubstr("width"));
  EXPECT_THAT(refusal(yaml(), "P5 -1 1 255\nx"), HasSubstr("width"));
  EXPECT_THAT(refusal(yaml(), "P5 2 1 70000\nxxxx"), HasSubstr("70000"));
  EXPECT_THAT(refusal(yaml(), "P2 2 1 9\n3 12\n"), HasSubstr("above the largest"));
  EXPECT_THAT(refusal(yaml(), "P2 2 1 9\n3 x  \n"), HasSubstr("pixel"));
  EXPECT_THAT(refusal(yaml(), "GIF89a....."), HasSubstr("neither a PGM"));
  EXPECT_THAT(refusal(yaml("", "none.pgm"), ""), HasSubstr("none.pgm"));
  std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x08\0\0\0\0xxxx",
                  33);
  EXPECT_THAT(refusal(yaml(), png), HasSubstr("claims"));
  EXPECT_THAT(refusal(yaml(), png.substr(0, 12)), HasSubstr("cut off"));
}

TEST(RosMap, DamagedPngIsNamed) {
  std::vector<std::uint8_t> png;
  cv::imencode(".png", cv::Mat(40, 40, CV_8UC1, cv::Scalar(254)), png);
  const std::string whole(png.begin(), png.end());
  EXPECT_EQ(png_problem(whole), "");
  EXPECT_THAT(refusal(yaml(), whole.substr(0, whole.size() - 14)), HasSubstr("cut off"));
  std::string flipped = whole;
  flipped[50] = static_cast<char>(flipped[50] ^ 4);
  EXPECT_THAT(refusal(yaml(), flipped), HasSubstr("checksum"));
}

TEST(RosMap, SavedMapComesBackEqualInFullPrecision) {
  const ScratchFolder folder;
  OccupancyGrid grid({0.1 / 3.0, {-12.345678901234567, 1e-7}, 5, 3});
  grid.cells = {0, 100, -1, 64, 65, -1, -1, 0, 0, 0, 100, 100, 0, -1, 30};
  save_ros_map(grid, folder / "my map.yaml");
  std::vector<std::string> warnings;
  const OccupancyGrid back = load_ros_map(folder / "my map.yaml", warnings);
  EXPECT_TRUE(back.geometry == grid.geometry);
  EXPECT_THAT(back.cells, ElementsAre(0, 100, -1, 0, 100, -1, -1, 0, 0, 0, 100, 100, 0, -1, 0));
  EXPECT_EQ(folder.count_entries(), 2u);
}

TEST(RosMap, MainFileMayNotBeTheImage) {
  EXPECT_THROW(save_ros_map(OccupancyGrid({0.1, {}, 1, 1}), "/tmp/x.pgm"), InputError);
}

TEST(RosMap, ReadsTheMapsPeopleUse) {
  const auto folder = test::shared_data() / "maps/ros";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  int maps = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".yaml") continue;
    std::vector<std::string> warnings;
    const OccupancyGrid grid = load_ros_map(entry.path(), warnings);
    EXPECT_TRUE(warnings.empty()) << entry.path();
    EXPECT_NE(std::count(grid.cells.begin(), grid.cells.end(), 0), 0) << entry.path();
    EXPECT_NE(std::count(grid.cells.begin(), grid.cells.end(), 100), 0) << entry.path();
    ++maps;
  }
  EXPECT_EQ(maps, 5);
}

}  // namespace
}  // namespace rovigo::maps
