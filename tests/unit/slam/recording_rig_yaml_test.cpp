#include "slam/recording/rig_yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/recordings.h"

namespace rovigo::slam {
namespace {

using ::testing::HasSubstr;

class RigYaml : public ::testing::Test {
 protected:
  std::filesystem::path file(const std::string& text) const {
    test::write_bytes(folder_ / "f.yaml", text);
    return folder_ / "f.yaml";
  }
  std::string camera_error(const std::string& text) const {
    return test::input_error_of([&] { read_camera_info(file(text)); });
  }
  test::TemporaryFolder folder_;
};

constexpr const char* kCalibration = R"(image_width: 640
image_height: 480
camera_name: head
camera_matrix: {rows: 3, cols: 3, data: [500.5, 0, 320.25, 0, 501.5, 240.75, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0.1, -0.2, 0.001, -0.002, 0.3]}
)";

std::string with(std::string text, const std::string& old, const std::string& instead) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, old.size(), instead);
}

TEST_F(RigYaml, ReadsACalibrationFile) {
  const auto camera = read_camera_info(file(kCalibration));
  EXPECT_EQ(camera.ncols, 640U);
  EXPECT_EQ(camera.nrows, 480U);
  EXPECT_DOUBLE_EQ(camera.fx(), 500.5);
  EXPECT_DOUBLE_EQ(camera.cy(), 240.75);
  EXPECT_DOUBLE_EQ(camera.k1(), 0.1);
  EXPECT_DOUBLE_EQ(camera.p2(), -0.002);
  EXPECT_DOUBLE_EQ(camera.k3(), 0.3);
}

TEST_F(RigYaml, ReadsACameraInfoMessage) {
  const auto camera = read_camera_info(
      file("height: 480\nwidth: 640\ndistortion_model: plumb_bob\nD: [0, 0, 0, 0, 0]\n"
           "K: [500.0, 0.0, 320.0, 0.0, 501.0, 240.0, 0.0, 0.0, 1.0]\n"));
  EXPECT_DOUBLE_EQ(camera.fy(), 501.0);
  EXPECT_EQ(camera.distortion, mrpt::img::DistortionModel::none);
}

TEST_F(RigYaml, CalibrationWrittenIsReadBackExactly) {
  auto camera = read_camera_info(file(kCalibration));
  camera.fx(517.0 + 1.0 / 3.0);
  const auto again = read_camera_info(file(camera_info_text(camera)));
  EXPECT_EQ(again.intrinsicParams, camera.intrinsicParams);
  EXPECT_EQ(again.dist, camera.dist);
  camera.dist = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
  EXPECT_EQ(read_camera_info(file(camera_info_text(camera))).dist, camera.dist);
}

TEST_F(RigYaml, SaysWhatIsWrongWithACalibration) {
  EXPECT_THAT(camera_error(with(kCalibration, "500.5", "-1")), HasSubstr("focal length -1"));
  EXPECT_THAT(camera_error(with(kCalibration, "500.5", ".nan")), HasSubstr("camera_matrix"));
  EXPECT_THAT(camera_error(with(kCalibration, "500.5", "wide")), HasSubstr("camera_matrix"));
  EXPECT_THAT(camera_error(with(kCalibration, "320.25", "3000")), HasSubstr("principal point"));
  EXPECT_THAT(camera_error(with(kCalibration, ", 0, 0, 1]", "]")), HasSubstr("9 numbers"));
  EXPECT_THAT(camera_error(with(kCalibration, "plumb_bob", "equidistant")),
              HasSubstr("equidistant"));
  EXPECT_THAT(camera_error(with(kCalibration, "0.1,", "1e9,")), HasSubstr("distortion"));
  EXPECT_THAT(camera_error(with(kCalibration, "640", "64000000")), HasSubstr("8192"));
  EXPECT_THAT(camera_error(with(kCalibration, "640", "-640")), HasSubstr("above 0"));
  EXPECT_THAT(camera_error(with(kCalibration, "image_width: 640\n", "")),
              HasSubstr("image_width is missing"));
}

TEST_F(RigYaml, WhatIsNoYamlIsRefusedWithTheLine) {
  EXPECT_THAT(camera_error("a: b\n: [}\n"), HasSubstr("f.yaml, line 2"));
  EXPECT_THAT(camera_error(""), HasSubstr("keys and values"));
  EXPECT_THAT(camera_error("- 1\n- 2\n"), HasSubstr("keys and values"));
  EXPECT_NE(camera_error(std::string(100, '\0')), "");
  EXPECT_NE(camera_error(std::string(2000, '[')), "");
}

TEST_F(RigYaml, ExtrinsicsWrittenAreReadBack) {
  const mrpt::poses::CPose3D pose = test::test_rig().base_from_camera;
  const auto again = read_extrinsics(file(extrinsics_text(pose)));
  const auto difference = again - pose;
  EXPECT_LT(difference.norm(), 1e-12);
  EXPECT_LT(std::abs(difference.yaw()) + std::abs(difference.pitch()) + std::abs(difference.roll()),
            1e-7);
}

TEST_F(RigYaml, ExtrinsicsMapCameraPointsIntoTheBase) {
  const auto pose = read_extrinsics(
      file("translation: [0.1, 0.0, 0.25]\nrotation_xyzw: [-0.5, 0.5, -0.5, 0.5]\n"));
  const auto ahead = pose.composePoint({0, 0, 2});
  EXPECT_NEAR(ahead.x, 2.1, 1e-12);
  EXPECT_NEAR(ahead.y, 0.0, 1e-12);
  EXPECT_NEAR(ahead.z, 0.25, 1e-12);
}

TEST_F(RigYaml, ExtrinsicsThatAreNoPoseAreRefused) {
  const auto error = [&](const std::string& text) {
    return test::input_error_of([&] { read_extrinsics(file(text)); });
  };
  EXPECT_THAT(error("translation: [0, 0, 0]\nrotation_xyzw: [0, 0, 0, 0]\n"),
              HasSubstr("quaternion of length 1"));
  EXPECT_THAT(error("translation: [0, 0]\nrotation_xyzw: [0, 0, 0, 1]\n"), HasSubstr("3 numbers"));
  EXPECT_THAT(error("translation: [0, 0, .inf]\nrotation_xyzw: [0, 0, 0, 1]\n"),
              HasSubstr("translation"));
  EXPECT_THAT(error("translation: [0, 0, 0]\n"), HasSubstr("rotation_xyzw is missing"));
}

TEST_F(RigYaml, SimulationOriginWrittenIsReadBackWhateverTheName) {
  for (const char* name : {"lab", "worlds/my \"lab\": #1", "no", "1e3"}) {
    const maps::SimulationOrigin origin{name, 18446744073709551615ULL, {0.1, -1.0 / 3.0, 3.0}};
    const auto again = read_simulation(file(simulation_text(origin)));
    EXPECT_EQ(again.world, origin.world);
    EXPECT_EQ(again.seed, origin.seed);
    EXPECT_EQ(again.world_from_map.y, origin.world_from_map.y);
  }
}

TEST(TumCameraByName, KnowsTheThreeFoldersAndNoOther) {
  EXPECT_NEAR(tum_camera_by_name("rgbd_dataset_freiburg1_rpy")->fx(), 517.3, 0.1);
  EXPECT_NEAR(tum_camera_by_name("rgbd_dataset_freiburg3_office")->fy(), 539.2, 0.1);
  EXPECT_FALSE(tum_camera_by_name("rgbd_dataset_freiburg4"));
  EXPECT_FALSE(tum_camera_by_name("my_lab"));
  EXPECT_EQ(tum_rolling_shutter_by_name("rgbd_dataset_freiburg1_rpy"), 0.026);
  EXPECT_EQ(tum_rolling_shutter_by_name("my_lab"), 0.0);
}

}  // namespace
}  // namespace rovigo::slam
