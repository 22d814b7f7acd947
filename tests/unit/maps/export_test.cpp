#include "maps/export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "maps/error.h"
#include "maps/ros_map.h"
#include "maps/view_cloud.h"
#include "tests/unit/maps/random_map.h"
#include "tests/unit/maps/test_support.h"

namespace rovigo::maps {
namespace {

using test::bytes_of;
using test::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kWallM = 2.0;

/// One view: the rover at (1, 2) heading north, its camera 0.1 m ahead and 0.25 m up, before a flat
/// wall of one colour kWallM away. Everything then lies at y = 4.1.
SavedMap wall_map() {
  SavedMap map;
  map.metadata.camera.ncols = 80;
  map.metadata.camera.nrows = 60;
  map.metadata.camera.setIntrinsicParamsFromValues(60.0, 60.0, 39.5, 29.5);
  mrpt::math::CMatrixDouble33 r;  // columns: the optical axes in base_link
  r.setZero();
  r(1, 0) = -1.0;
  r(2, 1) = -1.0;
  r(0, 2) = 1.0;
  map.metadata.base_from_camera = mrpt::poses::CPose3D(r, mrpt::math::TPoint3D(0.1, 0.0, 0.25));
  map.grid = OccupancyGrid({0.05, {-1.02, -0.51}, 30, 20}, OccupancyGrid::kFree);
  map.grid.at({4, 7}) = OccupancyGrid::kOccupied;
  map.grid.at({0, 0}) = OccupancyGrid::kUnknown;
  StoredKeyframe k;
  k.map_from_base = mrpt::poses::CPose3D(1.0, 2.0, 0.0, kPi / 2.0, 0.0, 0.0);
  cv::imencode(".png", cv::Mat(60, 80, CV_16UC1, cv::Scalar(1000.0 * kWallM)), k.depth_png);
  cv::imencode(".jpg", cv::Mat(60, 80, CV_8UC3, cv::Scalar(40, 80, 200)), k.color_jpeg);
  map.keyframes.push_back(k);
  map.trajectory = {{10.5, {}, true}, {11.0, k.map_from_base, false}};
  map.places = {{"desk \"A\"", {0.1, 0.2, 0.3}}};
  map.zones = {{"stairs", {{0.0, 0.0}, {0.0, 0.3}, {0.3, 0.0}}}};
  return map;
}

SavedMap grid_only() {
  SavedMap map;
  map.grid = wall_map().grid;
  return map;
}

std::string refusal(const SavedMap& map, ExportFormat format) {
  const ScratchFolder folder;
  try {
    export_map(map, format, folder / "out");
  } catch (const InputError& e) {
    EXPECT_EQ(folder.count_entries(), 0u);
    return e.what();
  }
  return "written";
}

std::string gunzip(const std::filesystem::path& path) {
  gzFile file = ::gzopen(path.c_str(), "rb");
  std::string bytes;
  char buffer[4096];
  for (int n = 0; (n = ::gzread(file, buffer, sizeof buffer)) > 0;) {
    bytes.append(buffer, static_cast<std::size_t>(n));
  }
  ::gzclose(file);
  return bytes;
}

bool runs(const std::string& command) {
  const int status = std::system((command + " > /dev/null 2>&1").c_str());
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(ViewPoints, LieWhereTheCameraSawThem) {
  const SavedMap map = wall_map();
  const ViewPoints view = view_points(map.keyframes[0], map.metadata, 1);
  EXPECT_NEAR(view.camera.x, 1.0, 1e-12);
  EXPECT_NEAR(view.camera.y, 2.1, 1e-12);
  EXPECT_NEAR(view.camera.z, 0.25, 1e-12);
  ASSERT_EQ(view.points.size(), 80u * 60u);
  for (const ColoredPoint& p : view.points) EXPECT_NEAR(p.y, 4.1, 1e-5);
  // The first pixel is the upper left one: west (heading north) and above the camera.
  EXPECT_NEAR(view.points[0].x, 1.0 - 39.5 / 60.0 * kWallM, 1e-5);
  EXPECT_NEAR(view.points[0].z, 0.25 + 29.5 / 60.0 * kWallM, 1e-5);
  EXPECT_NEAR(view.points[0].r, 200, 4);
  EXPECT_NEAR(view.points[0].b, 40, 4);
}

TEST(ViewPoints, ImagesOfHalfTheCamerasSizeMeanTheSame) {
  SavedMap map = wall_map();
  map.metadata.camera.ncols = 160;
  map.metadata.camera.nrows = 120;
  map.metadata.camera.setIntrinsicParamsFromValues(120.0, 120.0, 79.0, 59.0);
  const ViewPoints view = view_points(map.keyframes[0], map.metadata, 1);
  EXPECT_NEAR(view.points[0].x, 1.0 - 39.5 / 60.0 * kWallM, 1e-5);
}

TEST(ViewPoints, NoReturnGivesNoPointAndStrideThinsThem) {
  SavedMap map = wall_map();
  EXPECT_EQ(view_points(map.keyframes[0], map.metadata, 4).points.size(), 20u * 15u);
  cv::imencode(".png", cv::Mat(60, 80, CV_16UC1, cv::Scalar(0)), map.keyframes[0].depth_png);
  EXPECT_TRUE(view_points(map.keyframes[0], map.metadata, 1).points.empty());
}

TEST(ViewPoints, BrokenImagesAreNamed) {
  SavedMap map = wall_map();
  map.keyframes[0].depth_png.resize(40);
  EXPECT_THROW(view_points(map.keyframes[0], map.metadata, 1), InputError);
  map = wall_map();
  map.metadata.camera.setIntrinsicParamsFromValues(0, 0, 0, 0);
  EXPECT_THROW(view_points(map.keyframes[0], map.metadata, 1), InputError);
}

TEST(VoxelFilter, AveragesPointsInACube) {
  VoxelFilter filter(0.1);
  filter.add({{0.01F, 0.02F, -0.03F, 10, 0, 0}, {0.03F, 0.04F, -0.05F, 21, 0, 0}});
  filter.add({{5.0F, 0.0F, 0.0F, 1, 2, 3}});
  const auto points = filter.points();
  ASSERT_EQ(points.size(), 2u);
  EXPECT_FLOAT_EQ(points[0].x, 0.02F);
  EXPECT_FLOAT_EQ(points[0].z, -0.04F);
  EXPECT_EQ(points[0].r, 16);
  EXPECT_EQ(points[1].b, 3);
}

TEST(Export, FormatNamesAreThoseOfTheCommandLine) {
  for (const char* name : {"ros", "png", "ply", "pcd", "octomap", "gridmap", "simplemap",
                           "trajectory", "geojson", "keepout"}) {
    EXPECT_TRUE(parse_export_format(name).has_value()) << name;
  }
  EXPECT_FALSE(parse_export_format("stl").has_value());
}

TEST(Export, PlyHoldsTheWallInColour) {
  const ScratchFolder folder;
  export_map(wall_map(), ExportFormat::kPly, folder / "a.ply", {.cloud_voxel_m = 0.05});
  const std::string bytes = bytes_of(folder / "a.ply");
  const std::size_t body = bytes.find("end_header\n") + 11;
  const std::string header = bytes.substr(0, body);
  EXPECT_THAT(header, StartsWith("ply\nformat binary_little_endian"));
  EXPECT_THAT(header, HasSubstr("property float z\nproperty uchar red\n"));
  const auto count =
      static_cast<std::size_t>(std::stoul(header.substr(header.find("vertex ") + 7)));
  EXPECT_GT(count, 500u);
  ASSERT_GE(bytes.size() - body, count * 15);
  for (std::size_t i = 0; i < count; ++i) {
    float xyz[3];
    std::memcpy(xyz, bytes.data() + body + i * 15, sizeof xyz);
    EXPECT_NEAR(xyz[1], 4.1, 1e-4);
    EXPECT_NEAR(static_cast<unsigned char>(bytes[body + i * 15 + 12]), 200, 4);
  }
}

TEST(Export, PcdIsWrittenAndRepeatsItself) {
  const ScratchFolder folder;
  export_map(wall_map(), ExportFormat::kPcd, folder / "a.pcd");
  export_map(wall_map(), ExportFormat::kPcd, folder / "b.pcd");
  EXPECT_THAT(bytes_of(folder / "a.pcd"),
              testing::AllOf(HasSubstr("FIELDS x y z rgb"), HasSubstr("DATA binary_compressed")));
  EXPECT_EQ(bytes_of(folder / "a.pcd"), bytes_of(folder / "b.pcd"));
}

TEST(Export, OctomapHoldsTheWallAndFreeSpaceBeforeIt) {
  const ScratchFolder folder;
  export_map(wall_map(), ExportFormat::kOctomap, folder / "a.bt");
  EXPECT_THAT(bytes_of(folder / "a.bt"), StartsWith("# Octomap OcTree binary file"));
  if (!runs("which bt2vrml")) GTEST_SKIP() << "octomap-tools is not installed";
  ASSERT_TRUE(runs("cd " + folder.path().string() + " && bt2vrml a.bt"));
  std::istringstream wrl(bytes_of(folder / "a.bt.wrl"));
  int voxels = 0;
  for (std::string line; std::getline(wrl, line);) {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    const std::size_t at = line.find("translation ");
    if (at == std::string::npos) continue;
    if (std::sscanf(line.c_str() + at, "translation %lf %lf %lf", &x, &y, &z) != 3) continue;
    EXPECT_NEAR(y, 4.1, 0.051);
    ++voxels;
  }
  EXPECT_GT(voxels, 100);
}

TEST(Export, OctomapOfAMapWithoutViewsIsALayer) {
  const ScratchFolder folder;
  export_map(grid_only(), ExportFormat::kOctomap, folder / "a.bt");
  EXPECT_THAT(bytes_of(folder / "a.bt"), HasSubstr("res 0.05"));
}

TEST(Export, GridmapHoldsMrptsProbabilityOfFree) {
  const ScratchFolder folder;
  const SavedMap map = wall_map();
  export_map(map, ExportFormat::kGridmap, folder / "a.gridmap");
  const std::string bytes = gunzip(folder / "a.gridmap");
  const std::string name = "mrpt::maps::COccupancyGridMap2D";
  ASSERT_EQ(bytes.find(name), 1u);
  // Class name, its version, bits of a cell, then sizes and limits.
  const char* at = bytes.data() + 1 + name.size() + 2;
  std::uint32_t size[2];
  float limits[5];
  std::memcpy(size, at, sizeof size);
  std::memcpy(limits, at + sizeof size, sizeof limits);
  EXPECT_THAT(size, ElementsAre(30u, 20u));
  EXPECT_THAT(
      limits,
      ElementsAre(testing::FloatNear(-1.02F, 1e-5F), testing::FloatNear(0.48F, 1e-5F),
                  testing::FloatNear(-0.51F, 1e-5F), testing::FloatNear(0.49F, 1e-5F), 0.05F));
  const auto* cells = reinterpret_cast<const signed char*>(at + sizeof size + sizeof limits);
  for (std::size_t i = 0; i < map.grid.cells.size(); ++i) {
    const std::int8_t ours = map.grid.cells[i];
    const int sign = (cells[i] > 0) - (cells[i] < 0);
    EXPECT_EQ(sign, OccupancyGrid::is_unknown(ours) ? 0 : OccupancyGrid::is_free(ours) ? 1 : -1);
  }
}

TEST(Export, SimplemapHoldsPoseAndObservation) {
  const ScratchFolder folder;
  export_map(wall_map(), ExportFormat::kSimplemap, folder / "a.simplemap");
  EXPECT_THAT(gunzip(folder / "a.simplemap"),
              testing::AllOf(HasSubstr("mrpt::maps::CSimpleMap"),
                             HasSubstr("mrpt::poses::CPose3DPDFGaussian"),
                             HasSubstr("mrpt::obs::CObservation3DRangeScan")));
}

TEST(Export, TrajectoryIsTumTextWithItsFrame) {
  std::istringstream text(trajectory_text(wall_map()));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "# map_from_base_link");
  std::getline(text, line);
  std::getline(text, line);
  EXPECT_EQ(line,
            "10.5000000 0.000000000 0.000000000 0.000000000 0.000000000 0.000000000 "
            "0.000000000 1.000000000");
  std::getline(text, line);
  EXPECT_THAT(line, StartsWith("11.0000000 1.000000000 2.000000000 0.000000000 "));
  EXPECT_THAT(line, HasSubstr(" 0.707106781 0.707106781"));
}

TEST(Export, GeojsonHoldsZonePlaceTrajectoryAndOutline) {
  const auto json = nlohmann::json::parse(geojson_text(wall_map()));
  EXPECT_EQ(json["type"], "FeatureCollection");
  std::map<std::string, nlohmann::json> by_kind;
  for (const auto& f : json["features"]) by_kind[f["properties"]["kind"]] = f;
  ASSERT_EQ(by_kind.size(), 4u);
  const auto ring = by_kind["no_go_zone"]["geometry"]["coordinates"][0];
  ASSERT_EQ(ring.size(), 4u) << "closed";
  EXPECT_EQ(ring[0], ring[3]);
  // Counter-clockwise, although the zone was given clockwise.
  const auto cross = [&](int a, int b) {
    return ring[a][0].get<double>() * ring[b][1].get<double>() -
           ring[b][0].get<double>() * ring[a][1].get<double>();
  };
  EXPECT_GT(cross(0, 1) + cross(1, 2) + cross(2, 0), 0.0);
  EXPECT_EQ(by_kind["place"]["properties"]["name"], "desk \"A\"");
  EXPECT_EQ(by_kind["trajectory"]["geometry"]["coordinates"].size(), 2u);
  EXPECT_EQ(by_kind["outline"]["geometry"]["type"], "Polygon");
}

TEST(Export, GeojsonSurvivesNamesThatAreNoUtf8) {
  SavedMap map = wall_map();
  map.places[0].name = "\xff\xfe";
  EXPECT_NO_THROW(nlohmann::json::parse(geojson_text(map)));
}

TEST(Export, PictureIsAPngOfSensibleSize) {
  const Blob png = draw_map_png(wall_map());
  const cv::Mat image = cv::imdecode(png, cv::IMREAD_COLOR);
  ASSERT_FALSE(image.empty());
  EXPECT_EQ(image.cols, 30 * 12);
  const cv::Vec3b wall = image.at<cv::Vec3b>((19 - 7) * 12 + 6, 4 * 12 + 6);
  EXPECT_LT(wall[0] + wall[1] + wall[2], 200);
  EXPECT_NO_THROW(draw_map_png(grid_only()));
  EXPECT_THROW(draw_map_png(SavedMap{}), InputError);
}

TEST(Export, KeepoutMaskHoldsOnlyTheZones) {
  const ScratchFolder folder;
  export_map(wall_map(), ExportFormat::kKeepout, folder / "mask.yaml");
  std::vector<std::string> warnings;
  const OccupancyGrid mask = load_ros_map(folder / "mask.yaml", warnings);
  EXPECT_TRUE(OccupancyGrid::is_occupied(mask.at(mask.geometry.cell_at({0.05, 0.05}))));
  EXPECT_EQ(mask.at({4, 7}), OccupancyGrid::kFree);
}

TEST(Export, RosMapIsReadByMrptsOwnTool) {
  if (!runs("which ros-map-yaml2mrpt")) GTEST_SKIP() << "mrpt-apps is not installed";
  const ScratchFolder folder;
  export_map(wall_map(), ExportFormat::kRos, folder / "map.yaml");
  ASSERT_TRUE(runs("cd " + folder.path().string() + " && ros-map-yaml2mrpt -i map.yaml"));
  std::string theirs;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    if (entry.path().string().find("gridmap") != std::string::npos) theirs = gunzip(entry.path());
  }
  ASSERT_FALSE(theirs.empty()) << "the tool wrote no grid map";
  EXPECT_THAT(theirs, HasSubstr("COccupancyGridMap2D"));
  const std::uint32_t size[2] = {30, 20};
  EXPECT_NE(theirs.find(std::string(reinterpret_cast<const char*>(size), sizeof size)),
            std::string::npos);
}

TEST(Export, FormatsMadeOfViewsSayWhenThereAreNone) {
  EXPECT_THAT(refusal(grid_only(), ExportFormat::kPly), HasSubstr("no views"));
  EXPECT_THAT(refusal(grid_only(), ExportFormat::kPcd), HasSubstr("no views"));
  EXPECT_THAT(refusal(grid_only(), ExportFormat::kSimplemap), HasSubstr("no views"));
  EXPECT_THAT(refusal(grid_only(), ExportFormat::kTrajectory), HasSubstr("no trajectory"));
}

TEST(Export, BrokenViewLeavesNoFile) {
  SavedMap map = wall_map();
  map.keyframes[0].depth_png.resize(30);
  EXPECT_THAT(refusal(map, ExportFormat::kOctomap), HasSubstr("keyframe 0"));
  EXPECT_THAT(refusal(map, ExportFormat::kPly), HasSubstr("keyframe 0"));
}

TEST(Export, MissingPluginIsNamedWithItsPlace) {
  const ScratchFolder folder;
  try {
    export_map(wall_map(), ExportFormat::kPly, folder / "a.ply", {.plugin_folder = "/nowhere"});
    FAIL() << "no error";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("/nowhere/rovigo_exchange.so"));
  }
}

TEST(LoadAnyMap, TakesRosAndMovingAiMapsByTheirExtension) {
  const ScratchFolder folder;
  std::vector<std::string> warnings;
  export_map(wall_map(), ExportFormat::kRos, folder / "map.yaml");
  EXPECT_EQ(load_any_map(folder / "map.yaml", warnings).grid.cells, wall_map().grid.cells);
  test::put_bytes(folder / "a.map", "type octile\nheight 1\nwidth 2\nmap\n.@\n");
  EXPECT_THAT(load_any_map(folder / "a.map", warnings).grid.cells, ElementsAre(0, 100));
  save_map(wall_map(), folder / "odd_name");
  EXPECT_EQ(test::difference(load_any_map(folder / "odd_name", warnings), wall_map()), "");
  test::put_bytes(folder / "a.txt", "hello");
  EXPECT_THROW(load_any_map(folder / "a.txt", warnings), InputError);
  EXPECT_THROW(load_any_map(folder / "none", warnings), InputError);
}

}  // namespace
}  // namespace rovigo::maps
