// TUM directories: written, read back, damaged in every way a disk or a person can.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>

#include "slam/recording/images.h"
#include "slam/recording/tum_lists.h"
#include "tests/support/recordings.h"

namespace rovigo::slam {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationIMU;
using mrpt::obs::CObservationOdometry;
using test::fs::path;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class TumDirectory : public ::testing::Test {
 protected:
  void SetUp() override {
    written_ = test::test_observations(kFrames);
    test::write_all(*create_tum_directory(directory(), test::test_info()), written_);
  }
  path directory() const { return folder_ / "rec"; }
  path file(const std::string& name) const { return directory() / name; }
  std::string open_error() const {
    return test::input_error_of([this] { open_recording(directory()); });
  }
  /// The image file of frame `index`, as listed.
  path image(const std::string& list, std::size_t index) const {
    return directory() / read_image_list(file(list)).at(index).path;
  }

  static constexpr int kFrames = 6;
  test::TemporaryFolder folder_;
  std::vector<mrpt::obs::CObservation::Ptr> written_;
};

TEST_F(TumDirectory, ReadsBackEveryObservationInOrder) {
  test::expect_reads_back(directory(), written_);
}

TEST_F(TumDirectory, KeepsDepthToATenthOfAMillimetreAndColourToJpeg) {
  const auto reader = open_recording(directory());
  const auto read = test::only<CObservation3DRangeScan>(test::read_all(*reader));
  const auto written = test::only<CObservation3DRangeScan>(written_);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_LE(cv::norm(depth_in_metres(*read[i]), depth_in_metres(*written[i]), cv::NORM_INF),
              1e-4);
    EXPECT_LT(cv::norm(color_view(*read[i]), color_view(*written[i]), cv::NORM_L1) /
                  static_cast<double>(color_view(*read[i]).total() * 3),
              4.0);
  }
}

TEST_F(TumDirectory, ConvertsDepthOfAnotherUnitToFiveThousandPerMetre) {
  const Rig rig = test::test_rig();
  const auto millimetres = test::test_frame(20.0, rig, 0.001F);
  test::write_all(*create_tum_directory(folder_ / "mm", test::test_info()), {millimetres});
  const auto reader = open_recording(folder_ / "mm");
  const auto read = test::only<CObservation3DRangeScan>(test::read_all(*reader));
  ASSERT_THAT(read, SizeIs(1));
  EXPECT_FLOAT_EQ(read[0]->rangeUnits, 1.0F / 5000);
  EXPECT_LE(cv::norm(depth_in_metres(*read[0]), depth_in_metres(*millimetres), cv::NORM_INF), 2e-4);
}

TEST_F(TumDirectory, KeepsImuAndWheelsToTheLastDigit) {
  const auto reader = open_recording(directory());
  const auto read = test::read_all(*reader);
  const auto imu = test::only<CObservationIMU>(read);
  const auto imu_written = test::only<CObservationIMU>(written_);
  ASSERT_EQ(imu.size(), imu_written.size());
  for (std::size_t i = 0; i < imu.size(); ++i) {
    EXPECT_EQ(imu[i]->rawMeasurements, imu_written[i]->rawMeasurements);
  }
  const auto wheels = test::only<CObservationOdometry>(read);
  const auto wheels_written = test::only<CObservationOdometry>(written_);
  ASSERT_EQ(wheels.size(), wheels_written.size());
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    EXPECT_NEAR(wheels[i]->odometry.x(), wheels_written[i]->odometry.x(), 1e-12);
    EXPECT_NEAR(wheels[i]->odometry.y(), wheels_written[i]->odometry.y(), 1e-12);
    EXPECT_NEAR(wheels[i]->odometry.phi(), wheels_written[i]->odometry.phi(), 1e-12);
    EXPECT_EQ(wheels[i]->hasVelocities, wheels_written[i]->hasVelocities);
    EXPECT_NEAR(wheels[i]->velocityLocal.omega, wheels_written[i]->velocityLocal.omega, 1e-5);
  }
}

TEST_F(TumDirectory, KeepsCalibrationExtrinsicsAndOrigin) {
  const RecordingInfo info = open_recording(directory())->info();
  const RecordingInfo expected = test::test_info();
  EXPECT_EQ(info.name, "rec");
  EXPECT_EQ(info.format, "tum");
  EXPECT_EQ(info.rig.camera.intrinsicParams, expected.rig.camera.intrinsicParams);
  EXPECT_EQ(info.rig.camera.ncols, expected.rig.camera.ncols);
  EXPECT_LT((info.rig.base_from_camera - expected.rig.base_from_camera).norm(), 1e-9);
  EXPECT_TRUE(info.rig.has_extrinsics && info.rig.has_imu && info.rig.has_wheels);
  ASSERT_TRUE(info.simulation);
  EXPECT_EQ(info.simulation->world, "lab");
  EXPECT_EQ(info.simulation->seed, 42U);
  EXPECT_DOUBLE_EQ(info.simulation->world_from_map.y, -2.25);
  EXPECT_DOUBLE_EQ(info.simulation->world_from_map.phi, 0.3);
}

TEST_F(TumDirectory, TheSameInputGivesTheSameBytes) {
  test::write_all(*create_tum_directory(folder_ / "again", test::test_info()), written_);
  for (const auto& entry : test::fs::recursive_directory_iterator(directory())) {
    if (entry.is_directory()) continue;
    const path other = folder_ / "again" / entry.path().lexically_relative(directory());
    EXPECT_EQ(test::read_bytes(entry.path()), test::read_bytes(other)) << other;
  }
}

TEST_F(TumDirectory, AWriterThatIsNotFinishedLeavesNothing) {
  {
    const auto writer = create_tum_directory(folder_ / "half", test::test_info());
    writer->write(*written_.front());
  }
  EXPECT_FALSE(test::fs::exists(folder_ / "half"));
  int entries = 0;
  for ([[maybe_unused]] const auto& entry : test::fs::directory_iterator(folder_.path())) ++entries;
  EXPECT_EQ(entries, 1);  // the recording of SetUp alone
}

TEST_F(TumDirectory, AnOldRecordingStandsUntilTheNewOneIsWhole) {
  const auto writer = create_tum_directory(directory(), test::test_info());
  writer->write(*written_.at(2));
  EXPECT_EQ(test::read_all(*open_recording(directory())).size(), written_.size());
  writer->finish();
  EXPECT_EQ(test::read_all(*open_recording(directory())).size(), 1U);
}

TEST_F(TumDirectory, AFolderThatIsNoRecordingIsNeverReplaced) {
  test::fs::create_directory(folder_ / "thesis");
  test::write_bytes(folder_ / "thesis/chapter.tex", "years of work");
  EXPECT_THAT(
      test::input_error_of([&] { create_tum_directory(folder_ / "thesis", test::test_info()); }),
      HasSubstr("is no recording"));
  EXPECT_EQ(test::read_bytes(folder_ / "thesis/chapter.tex"), "years of work");
}

TEST_F(TumDirectory, WithoutAssociationsColourAndDepthArePairedByTime) {
  test::fs::remove(file("associations.txt"));
  EXPECT_EQ(test::read_all(*open_recording(directory())).size(), written_.size());
}

TEST_F(TumDirectory, AColourImageWithoutDepthIsLeftOutAndSaid) {
  test::fs::remove(file("associations.txt"));
  test::write_bytes(file("rgb.txt"), test::read_bytes(file("rgb.txt")) + "99 rgb/late.jpg\n");
  const auto reader = open_recording(directory());
  EXPECT_THAT(test::only<CObservation3DRangeScan>(test::read_all(*reader)), SizeIs(kFrames));
  EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr("1 of 7 colour images"));
}

TEST_F(TumDirectory, AMissingImageIsSkippedCountedAndNamed) {
  const path missing = image("rgb.txt", 2);
  test::fs::remove(missing);
  const auto reader = open_recording(directory());
  EXPECT_THAT(test::only<CObservation3DRangeScan>(test::read_all(*reader)), SizeIs(kFrames - 1));
  EXPECT_EQ(reader->skipped(), 1);
  EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr(missing.string()));
}

TEST_F(TumDirectory, AnImageCutAtAnyQuarterIsSkippedWithoutAWordOnTheTerminal) {
  for (const char* list : {"rgb.txt", "depth.txt"}) {
    const path victim = image(list, 3);
    const std::string whole = test::read_bytes(victim);
    for (int quarter = 0; quarter < 4; ++quarter) {
      test::write_bytes(victim,
                        whole.substr(0, whole.size() * static_cast<std::size_t>(quarter) / 4));
      ::testing::internal::CaptureStderr();
      const auto reader = open_recording(directory());
      const auto read = test::only<CObservation3DRangeScan>(test::read_all(*reader));
      EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
      EXPECT_THAT(read, SizeIs(kFrames - 1)) << victim << " cut at quarter " << quarter;
      EXPECT_EQ(reader->skipped(), 1);
      EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr(victim.filename().string()));
    }
    test::write_bytes(victim, whole);
  }
}

TEST_F(TumDirectory, AFlippedBitInDepthIsCaughtByTheChecksum) {
  const path victim = image("depth.txt", 1);
  std::string bytes = test::read_bytes(victim);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x10);
  test::write_bytes(victim, bytes);
  const auto reader = open_recording(directory());
  test::read_all(*reader);
  EXPECT_EQ(reader->skipped(), 1);
  EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr("checksum"));
}

TEST_F(TumDirectory, ADepthImageOf8BitsIsNotDepth) {
  cv::imwrite(image("depth.txt", 0).string(), cv::Mat(48, 64, CV_8UC1, cv::Scalar(7)));
  const auto reader = open_recording(directory());
  test::read_all(*reader);
  EXPECT_EQ(reader->skipped(), 1);
  EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr("16-bit grey PNG"));
}

TEST_F(TumDirectory, AnImageOfAnotherSizeIsSkipped) {
  cv::imwrite(image("rgb.txt", 0).string(), cv::Mat(24, 32, CV_8UC3, cv::Scalar(1, 2, 3)));
  const auto reader = open_recording(directory());
  test::read_all(*reader);
  EXPECT_EQ(reader->skipped(), 1);
  EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr("64 x 48"));
}

TEST_F(TumDirectory, GreyPngColourComesOutAsThreeChannels) {
  cv::imwrite((directory() / "rgb/grey.png").string(), cv::Mat(48, 64, CV_8UC1, cv::Scalar(90)));
  const auto frames = read_associations(file("associations.txt"));
  test::write_bytes(file("associations.txt"), "10 rgb/grey.png 10 " + frames[0].depth.string());
  const auto read =
      test::only<CObservation3DRangeScan>(test::read_all(*open_recording(directory())));
  ASSERT_THAT(read, SizeIs(1));
  EXPECT_EQ(color_view(*read[0]).type(), CV_8UC3);
  EXPECT_EQ(color_view(*read[0]).at<cv::Vec3b>(5, 5), cv::Vec3b(90, 90, 90));
}

TEST_F(TumDirectory, WithoutOneReadableFrameItIsRefused) {
  test::fs::remove_all(file("depth"));
  EXPECT_THAT(open_error(), HasSubstr("none of its 6 camera frames"));
}

TEST_F(TumDirectory, WithoutListsItIsRefusedWithTheirName) {
  test::fs::remove(file("associations.txt"));
  test::fs::remove(file("rgb.txt"));
  EXPECT_THAT(open_error(), HasSubstr("rgb.txt"));
}

TEST_F(TumDirectory, WithoutCalibrationItSaysHowToGiveIt) {
  test::fs::remove(file("camera_info.yaml"));
  EXPECT_THAT(open_error(), HasSubstr("--camera-info"));
}

TEST_F(TumDirectory, CameraInfoFromTheCommandLineOverrides) {
  const path other = folder_ / "other.yaml";
  std::string text = test::read_bytes(file("camera_info.yaml"));
  text.replace(text.find("55.25"), 5, "57.75");
  test::write_bytes(other, text);
  const auto reader = open_recording(directory(), {.camera_info = other});
  EXPECT_DOUBLE_EQ(reader->info().rig.camera.fx(), 57.75);
  const auto frames = test::only<CObservation3DRangeScan>(test::read_all(*reader));
  EXPECT_DOUBLE_EQ(frames.at(0)->cameraParams.fx(), 57.75);
}

TEST_F(TumDirectory, TumsOwnFoldersAreCalibratedByName) {
  for (const char* name :
       {"camera_info.yaml", "extrinsics.yaml", "imu.txt", "wheel_odometry.txt"}) {
    test::fs::remove(file(name));
  }
  const auto vga = [&] {
    cv::imwrite(image("rgb.txt", 0).string(), cv::Mat(480, 640, CV_8UC3, cv::Scalar(9, 9, 9)));
    cv::imwrite(image("depth.txt", 0).string(), cv::Mat(480, 640, CV_16UC1, cv::Scalar(5000)));
  };
  vga();
  test::fs::rename(directory(), folder_ / "rgbd_dataset_freiburg2_desk");
  const auto reader = open_recording(folder_ / "rgbd_dataset_freiburg2_desk/");
  EXPECT_NEAR(reader->info().rig.camera.fx(), 520.9, 0.1);
  EXPECT_EQ(reader->info().name, "rgbd_dataset_freiburg2_desk");
  EXPECT_FALSE(reader->info().rig.has_extrinsics);
  EXPECT_FALSE(reader->info().rig.has_wheels || reader->info().rig.has_imu);
  const auto frame = std::dynamic_pointer_cast<CObservation3DRangeScan>(reader->next());
  ASSERT_TRUE(frame);
  EXPECT_NEAR(frame->sensorPose.norm() + std::abs(frame->sensorPose.yaw()), 0.0, 1e-12);
}

struct BadLine {
  const char* file;
  const char* line;
  const char* complaint;
};

class BadTextLine : public TumDirectory, public ::testing::WithParamInterface<BadLine> {};

TEST_P(BadTextLine, IsRefusedWithFileAndLine) {
  const BadLine& bad = GetParam();
  const std::string old = test::read_bytes(file(bad.file));
  const auto line = std::count(old.begin(), old.end(), '\n') + 1;
  test::write_bytes(file(bad.file), old + bad.line + "\n");
  const std::string error = open_error();
  EXPECT_THAT(error, HasSubstr(std::string(bad.file) + ", line " + std::to_string(line) + ": "));
  EXPECT_THAT(error, HasSubstr(bad.complaint));
}

INSTANTIATE_TEST_SUITE_P(
    Hostile, BadTextLine,
    ::testing::Values(BadLine{"associations.txt", "1 rgb/a.jpg 1 depth/a.png", "sort the file"},
                      BadLine{"associations.txt", "99 rgb/a.jpg 99", "3 columns where 4"},
                      BadLine{"associations.txt", "99 /etc/passwd 99 depth/a.png", "inside"},
                      BadLine{"associations.txt", "99 rgb/a.jpg 99 ../../depth.png", "inside"},
                      BadLine{"associations.txt", "nan rgb/a.jpg 99 depth/a.png", "'nan'"},
                      BadLine{"associations.txt", "1e11 rgb/a.jpg 9 depth/a.png", "outside 0"},
                      BadLine{"imu.txt", "99 0 0 0 0 0", "6 columns where 7"},
                      BadLine{"imu.txt", "99 0 0 0 0 0 inf", "'inf'"},
                      BadLine{"imu.txt", "99 0 0 1e30 0 0 9.81", "beyond 10000"},
                      BadLine{"imu.txt", "1 0 0 0 0 0 9.81", "sort the file"},
                      BadLine{"imu.txt", "99 zero 0 0 0 0 9.81", "'zero'"},
                      BadLine{"wheel_odometry.txt", "99 0 0 0 0 0 0 0", "quaternion"},
                      BadLine{"wheel_odometry.txt", "99 0 0 0 0 0 1", "7 columns where 8"}));

TEST_F(TumDirectory, ASampleOfTheOldClockIsRefusedInRgbTxtToo) {
  test::fs::remove(file("associations.txt"));
  test::write_bytes(file("rgb.txt"), "5 rgb/a.jpg\n5 rgb/b.jpg\n");
  EXPECT_THAT(open_error(), HasSubstr("rgb.txt, line 2"));
}

TEST_F(TumDirectory, EmptyListsAreRefused) {
  for (const char* name : {"associations.txt"}) {
    test::write_bytes(file(name), "");
    EXPECT_THAT(open_error(), HasSubstr("no images are listed"));
  }
  test::fs::remove(file("associations.txt"));
  test::write_bytes(file("depth.txt"), "# nothing\n");
  EXPECT_THAT(open_error(), HasSubstr("no images are listed"));
}

TEST(Associate, PrefersTheClosestPairAndUsesEachImageOnce) {
  const std::vector<ImageEntry> color = {{1.000, "c0"}, {1.010, "c1"}, {2.0, "c2"}};
  const std::vector<ImageEntry> depth = {{1.009, "d0"}, {1.015, "d1"}, {2.021, "d2"}};
  const auto pairs = associate(color, depth, 0.02);
  ASSERT_THAT(pairs, SizeIs(2));
  EXPECT_EQ(pairs[0].color, "c0");
  EXPECT_EQ(pairs[0].depth, "d1");
  EXPECT_EQ(pairs[1].color, "c1");
  EXPECT_EQ(pairs[1].depth, "d0");
}

TEST(Associate, DepthMayBeNamedFirst) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "a.txt", "1.01 depth/1.png 1.00 rgb/1.png\n");
  const auto pairs = read_associations(folder / "a.txt");
  ASSERT_THAT(pairs, SizeIs(1));
  EXPECT_EQ(pairs[0].color, "rgb/1.png");
  EXPECT_DOUBLE_EQ(pairs[0].time_s, 1.00);
}

TEST(RealTumRecording, OpensAndPairsAllOfItsFrames) {
  const char* const data = std::getenv("ROVIGO_TEST_DATA");
  const path root = data != nullptr ? path(data) : path(ROVIGO_SOURCE_DIR) / "../shared/data";
  const path recording = root / "recordings/tum_freiburg1_rpy_half";
  if (!test::fs::exists(recording)) GTEST_SKIP() << recording << " is not here";
  const auto reader = open_recording(recording);
  EXPECT_NEAR(reader->info().rig.camera.fx(), 517.306408, 1e-9);
  EXPECT_FALSE(reader->info().rig.has_imu);  // accelerometer.txt is the Kinect's own
  int frames = 0;
  for (auto o = reader->next(); o && frames < 5; o = reader->next()) ++frames;
  EXPECT_EQ(frames, 5);
  EXPECT_EQ(reader->skipped(), 0);
}

}  // namespace
}  // namespace rovigo::slam
