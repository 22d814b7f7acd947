// ROS 1 bags: written by ROS's own library in the layouts people have, read back, damaged.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <tuple>

#include "slam/recording/depth_registration.h"
#include "slam/recording/images.h"
#include "tests/support/bag_recording.h"
#include "tests/support/recordings.h"

namespace rovigo::slam {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationIMU;
using mrpt::obs::CObservationOdometry;
using rovigo::test::BagCompression;
using rovigo::test::BagWriter;
using test::BagStyle;
using test::fs::path;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

constexpr int kFrames = 6;

std::string open_error(const path& file, const OpenOptions& options = {}) {
  return test::input_error_of([&] { test::read_all(*open_recording(file, options)); });
}

using Layout = std::tuple<BagStyle, BagCompression>;

class Bag : public ::testing::TestWithParam<Layout> {
 protected:
  void SetUp() override {
    written_ = test::test_observations(kFrames);
    if (style() == BagStyle::kRosDriver) {  // whose 16UC1 are millimetres
      for (auto& o : written_) {
        if (IS_CLASS(*o, CObservation3DRangeScan)) {
          o = test::test_frame(seconds_of(*o), test::test_rig(), 0.001F);
        }
      }
    }
    test::write_bag(file().string(), style(), std::get<1>(GetParam()), test::test_info(), written_);
  }
  BagStyle style() const { return std::get<0>(GetParam()); }
  path file() const { return folder_ / "rec.bag"; }

  test::TemporaryFolder folder_;
  std::vector<mrpt::obs::CObservation::Ptr> written_;
};

TEST_P(Bag, ReadsBackEveryObservationInOrder) {
  std::vector<mrpt::obs::CObservation::Ptr> expected;
  for (const auto& o : written_) {
    const bool is_wheels = IS_CLASS(*o, CObservationOdometry);
    if (!is_wheels || style() != BagStyle::kRealSenseRecorder) expected.push_back(o);
  }
  test::expect_reads_back(file(), expected);
}

TEST_P(Bag, KeepsColourAndDepthBitForBit) {
  const auto read = test::only<CObservation3DRangeScan>(test::read_all(*open_recording(file())));
  const auto written = test::only<CObservation3DRangeScan>(written_);
  ASSERT_EQ(read.size(), written.size());
  RegistrationGeometry geometry{test::test_rig().camera, test::test_rig().camera,
                                test::recorder_color_from_depth()};
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(cv::norm(color_view(*read[i]), color_view(*written[i]), cv::NORM_INF), 0.0);
    EXPECT_FLOAT_EQ(read[i]->rangeUnits, written[i]->rangeUnits);
    if (style() == BagStyle::kRealSenseRecorder) {  // depth is seen by a camera beside
      const auto expected =
          DepthRegistration(geometry).apply(written[i]->rangeImage, written[i]->rangeUnits, false);
      const cv::Mat a = depth_view(*read[i]);
      int different = 0;
      for (int v = 0; v < a.rows; ++v) {
        for (int u = 0; u < a.cols; ++u) different += a.at<std::uint16_t>(v, u) != expected(v, u);
      }
      EXPECT_LT(different, 5);  // the pose went through a quaternion
      EXPECT_GT(cv::norm(a, depth_view(*written[i]), cv::NORM_INF), 0.0);
    } else {
      EXPECT_EQ(read[i]->rangeImage, written[i]->rangeImage);
    }
  }
}

TEST_P(Bag, TurnsTheImuIntoTheRoversFrame) {
  const auto read = test::only<CObservationIMU>(test::read_all(*open_recording(file())));
  const auto written = test::only<CObservationIMU>(written_);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    const ImuSample a = imu_sample_of(*read[i]).value();
    const ImuSample b = imu_sample_of(*written[i]).value();
    EXPECT_LT((a.angular_rate_rad_s - b.angular_rate_rad_s).norm(), 1e-9) << "sample " << i;
    EXPECT_LT((a.specific_force_m_s2 - b.specific_force_m_s2).norm(), 1e-9) << "sample " << i;
  }
}

TEST_P(Bag, KnowsCalibrationExtrinsicsAndWhichSensorsThereAre) {
  const RecordingInfo info = open_recording(file())->info();
  const Rig expected = test::test_rig();
  const bool has_rover = style() != BagStyle::kRealSenseRecorder;
  EXPECT_EQ(info.name, "rec");
  EXPECT_EQ(info.format, "bag");
  EXPECT_EQ(info.rig.camera.intrinsicParams, expected.camera.intrinsicParams);
  EXPECT_EQ(info.rig.camera.nrows, expected.camera.nrows);
  EXPECT_TRUE(info.rig.has_imu);
  EXPECT_EQ(info.rig.has_wheels, has_rover);
  EXPECT_EQ(info.rig.has_extrinsics, has_rover);
  const mrpt::poses::CPose3D pose =
      has_rover ? expected.base_from_camera : base_from_optical(mrpt::poses::CPose3D());
  EXPECT_LT((info.rig.base_from_camera - pose).norm(), 1e-9);
  EXPECT_THAT(info.sources, SizeIs(has_rover ? 4 : 3));
}

std::string layout_name(const ::testing::TestParamInfo<Layout>& info) {
  const char* styles[] = {"RosDriver", "Tum", "RealSenseRecorder"};
  const char* compressions[] = {"Uncompressed", "Bz2", "Lz4"};
  return std::string(styles[static_cast<int>(std::get<0>(info.param))]) +
         compressions[static_cast<int>(std::get<1>(info.param))];
}

INSTANTIATE_TEST_SUITE_P(Layouts, Bag,
                         ::testing::Combine(::testing::Values(BagStyle::kRosDriver, BagStyle::kTum,
                                                              BagStyle::kRealSenseRecorder),
                                            ::testing::Values(BagCompression::kNone,
                                                              BagCompression::kBz2,
                                                              BagCompression::kLz4)),
                         layout_name);

/// A bag of single messages: a colour and a depth camera, and what a test adds or breaks.
class HandmadeBag : public ::testing::Test {
 protected:
  path file() const { return folder_ / "rec.bag"; }
  static rovigo::test::BagImageData color_image() {
    return {32, 24, 96, "rgb8", std::string(96 * 24, '\x40')};
  }
  static rovigo::test::BagImageData depth_image() {
    return {32, 24, 64, "16UC1", std::string(64 * 24, '\x08')};
  }
  static rovigo::test::BagCameraData camera() {
    return {32, 24, "plumb_bob", {}, {30, 30, 16, 12}};
  }
  /// One frame a tenth of a second, from second 10 on.
  static void frames(BagWriter& bag, int count, const rovigo::test::BagImageData& color,
                     const rovigo::test::BagImageData& depth) {
    for (int i = 0; i < count; ++i) {
      const std::uint64_t time_ns = 10'000'000'000 + static_cast<std::uint64_t>(i) * 100'000'000;
      bag.received(time_ns);
      bag.camera_info("/camera/rgb/camera_info", time_ns, "optical", camera());
      bag.image("/camera/rgb/image_raw", time_ns, "optical", color);
      bag.image("/camera/depth/image_raw", time_ns, "optical", depth);
    }
  }
  void write(const std::function<void(BagWriter&)>& fill) const {
    BagWriter bag(file().string(), BagCompression::kNone);
    fill(bag);
    bag.close();
  }

  test::TemporaryFolder folder_;
};

TEST_F(HandmadeBag, WithoutDepthSaysWhichTopicsThereAre) {
  write([](BagWriter& bag) {
    bag.received(10);
    bag.image("/camera/rgb/image_raw", 10, "optical", color_image());
  });
  EXPECT_THAT(open_error(file()), AllOf(HasSubstr("no topic holds depth images"),
                                        HasSubstr("/camera/rgb/image_raw"), HasSubstr("rgb8")));
}

TEST_F(HandmadeBag, WithTwoEqualCamerasAsksForOneToBeLeftOut) {
  write([](BagWriter& bag) {
    bag.received(10);
    for (const std::string camera : {"/left", "/right"}) {
      bag.image(camera + "/rgb", 10, "optical", color_image());
    }
    bag.image("/depth", 10, "optical", depth_image());
  });
  EXPECT_THAT(open_error(file()),
              AllOf(HasSubstr("/left/rgb"), HasSubstr("/right/rgb"), HasSubstr("rosbag filter")));
}

TEST_F(HandmadeBag, PrefersAlignedDepthAndColourOverInfrared) {
  write([](BagWriter& bag) {
    frames(bag, 2, color_image(), depth_image());
    auto grey = color_image();
    grey.encoding = "mono8";
    grey.step = 32;
    grey.bytes.resize(32 * 24);
    bag.image("/camera/infra1/image_rect_raw", 10, "infra", grey);
    bag.image("/camera/aligned_depth_to_color/image_raw", 10'000'000'000, "optical", depth_image());
    bag.image("/camera/aligned_depth_to_color/image_raw", 10'100'000'000, "optical", depth_image());
  });
  const auto reader = open_recording(file());
  EXPECT_EQ(reader->info().sources.at(0).second, "/camera/rgb/image_raw");
  EXPECT_EQ(reader->info().sources.at(1).second, "/camera/aligned_depth_to_color/image_raw");
}

TEST_F(HandmadeBag, NeverTakesATruthTopicForWheels) {
  write([](BagWriter& bag) {
    frames(bag, 2, color_image(), depth_image());
    bag.odometry("/ground_truth/odom", 10, {1, 2, 0, 0, 0, 0, 1});
    bag.odometry("/camera/odom/sample", 10, {1, 2, 0, 0, 0, 0, 1});
  });
  EXPECT_FALSE(open_recording(file())->info().rig.has_wheels);
}

TEST_F(HandmadeBag, LeavesOutAnAccelerometerWithoutGyro) {
  write([](BagWriter& bag) {
    frames(bag, 2, color_image(), depth_image());
    bag.imu("/imu", 10, "optical", {0, 0, 0}, {0, 0, 9.8}, true);
  });
  const auto reader = open_recording(file());
  EXPECT_FALSE(reader->info().rig.has_imu);
  EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr("/imu"));
}

TEST_F(HandmadeBag, ReadsCompressedImages) {
  const cv::Mat bgr(24, 32, CV_8UC3, cv::Scalar(10, 80, 200));
  cv::Mat depth(24, 32, CV_16UC1);
  cv::randu(depth, 300, 9000);
  std::vector<uchar> jpeg;
  std::vector<uchar> png;
  cv::imencode(".png", bgr, jpeg);
  cv::imencode(".png", depth, png);
  write([&](BagWriter& bag) {
    const std::uint64_t time_ns = 10'000'000'000;
    bag.received(time_ns);
    bag.camera_info("/camera/rgb/camera_info", time_ns, "optical", camera());
    bag.compressed_image("/camera/rgb/image_raw/compressed", time_ns, "optical", "bgr8; png",
                         {reinterpret_cast<const char*>(jpeg.data()), jpeg.size()});
    std::string packed(12, '\0');
    packed.append(png.begin(), png.end());
    bag.compressed_image("/camera/depth/image_raw/compressedDepth", time_ns, "optical",
                         "16UC1; compressedDepth png", packed);
  });
  const auto read = test::only<CObservation3DRangeScan>(test::read_all(*open_recording(file())));
  ASSERT_THAT(read, SizeIs(1));
  EXPECT_EQ(cv::norm(color_view(*read[0]), bgr, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(depth_view(*read[0]), depth, cv::NORM_INF), 0.0);
}

TEST_F(HandmadeBag, TakesFloatDepthThatIsNotANumberForNoReturn) {
  auto depth = depth_image();
  depth.encoding = "32FC1";
  depth.step = 128;
  std::vector<float> metres(32 * 24, 1.5F);
  metres[0] = std::nanf("");
  metres[1] = -1.0F;
  metres[2] = INFINITY;
  metres[3] = 20.0F;
  depth.bytes.assign(reinterpret_cast<const char*>(metres.data()), metres.size() * sizeof(float));
  write([&](BagWriter& bag) { frames(bag, 1, color_image(), depth); });
  const auto read = test::only<CObservation3DRangeScan>(test::read_all(*open_recording(file())));
  ASSERT_THAT(read, SizeIs(1));
  const cv::Mat seen = depth_in_metres(*read[0]);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(seen.at<float>(0, i), 0.0F) << i;
  EXPECT_FLOAT_EQ(seen.at<float>(5, 5), 1.5F);
}

TEST_F(HandmadeBag, SkipsFramesWhoseSizesContradictTheirBytes) {
  auto bad = depth_image();
  bad.height = 25;
  auto huge = depth_image();
  huge.width = huge.height = 0xFFFFFFFF;
  write([&](BagWriter& bag) {
    frames(bag, 3, color_image(), depth_image());
    bag.received(10'350'000'000);
    bag.image("/camera/rgb/image_raw", 10'350'000'000, "optical", color_image());
    bag.image("/camera/depth/image_raw", 10'350'000'000, "optical", bad);
    bag.image("/camera/rgb/image_raw", 10'400'000'000, "optical", color_image());
    bag.image("/camera/depth/image_raw", 10'400'000'000, "optical", huge);
  });
  const auto reader = open_recording(file());
  EXPECT_THAT(test::read_all(*reader), SizeIs(3));
  EXPECT_EQ(reader->skipped(), 2);
  EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr("32 x 25"));
}

TEST_F(HandmadeBag, WithOnlyDamagedFramesSaysWhatIsWrongWithTheFirst) {
  auto bad = depth_image();
  bad.step = 60;
  write([&](BagWriter& bag) { frames(bag, 2, color_image(), bad); });
  EXPECT_THAT(open_error(file()), AllOf(HasSubstr("none of its camera frames"), HasSubstr("60")));
}

TEST_F(HandmadeBag, WithoutCalibrationAsksForIt) {
  write([](BagWriter& bag) {
    bag.received(10);
    bag.image("/rgb", 10, "optical", color_image());
    bag.image("/depth", 10, "optical", depth_image());
  });
  EXPECT_THAT(open_error(file()), HasSubstr("--camera-info"));
}

TEST_F(HandmadeBag, WithImagesFarApartInTimeSaysSo) {
  write([](BagWriter& bag) {
    bag.received(10);
    bag.camera_info("/camera_info", 10'000'000'000, "optical", camera());
    bag.image("/rgb", 10'000'000'000, "optical", color_image());
    bag.image("/depth", 10'030'000'000, "optical", depth_image());
  });
  EXPECT_THAT(open_error(file()), HasSubstr("0.02 s"));
}

TEST_F(HandmadeBag, WarnsOfImagesTakenApart) {
  write([](BagWriter& bag) {
    for (std::uint64_t time_ns = 10'000'000'000; time_ns < 12'000'000'000; time_ns += 100'000'000) {
      bag.received(time_ns);
      bag.camera_info("/camera_info", time_ns, "optical", camera());
      bag.image("/rgb", time_ns, "optical", color_image());
      bag.image("/depth", time_ns + 15'000'000, "optical", depth_image());
    }
  });
  const auto reader = open_recording(file());
  EXPECT_THAT(test::read_all(*reader), SizeIs(20));
  EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr("15 ms after"));
}

TEST_F(HandmadeBag, IgnoresATransformThatIsNotFinite) {
  write([](BagWriter& bag) {
    bag.received(10'000'000'000);
    bag.transform_list("/tf_static", "base_link", "optical", {NAN, 0, 0, 0, 0, 0, 1});
    bag.transform_list("/tf_static", "a", "b", {0, 0, 0, 0, 0, 0, 1});
    bag.transform_list("/tf_static", "b", "a", {0, 0, 0, 0, 0, 0, 1});  // a loop
    frames(bag, 30, color_image(), depth_image());
  });
  const auto reader = open_recording(file());
  EXPECT_FALSE(reader->info().rig.has_extrinsics);
  EXPECT_THAT(test::read_all(*reader), SizeIs(30));
}

class DamagedBag : public HandmadeBag {
 protected:
  void SetUp() override {
    write([](BagWriter& bag) { frames(bag, 40, color_image(), depth_image()); });
    bytes_ = test::read_bytes(file());
  }
  std::string bytes_;
};

TEST_F(DamagedBag, WithoutItsIndexIsReadAsFarAsItIsWhole) {
  // What rosbag leaves behind when it is killed: the header says that no index was written.
  test::write_bytes(file(), bytes_.substr(0, bytes_.size() / 2));
  const auto reader = open_recording(file());
  EXPECT_THAT(test::only<CObservation3DRangeScan>(test::read_all(*reader)).size(),
              AllOf(::testing::Gt(5U), ::testing::Lt(40U)));
  EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr("rosbag reindex"));
}

TEST_F(DamagedBag, OfNothingOrOtherBytesIsRefused) {
  test::write_bytes(file(), "");
  EXPECT_THAT(open_error(file()), HasSubstr("the file is empty"));
  test::write_bytes(file(), "a text, no bag at all");
  EXPECT_THAT(open_error(file()), HasSubstr("not a ROS 1 bag"));
  test::write_bytes(file(), "#ROSBAG V1.2\n and so on");
  EXPECT_THAT(open_error(file()), HasSubstr("another version"));
  test::write_bytes(file(), bytes_.substr(0, 30));
  EXPECT_THAT(open_error(file()), HasSubstr("cut short"));
}

TEST_F(DamagedBag, GivesInTimeOrderWhatIsLeftOrOneSentence) {
  std::mt19937 generator(11);
  const auto any = [&](std::size_t below) { return generator() % below; };
  int read_something = 0;
  int refused = 0;
  for (int round = 0; round < 150; ++round) {
    std::string damaged = bytes_;
    for (std::size_t n = 1 + any(6); n > 0; --n) {
      damaged[any(damaged.size())] = any(2) == 0 ? '\xFF' : static_cast<char>(generator());
    }
    if (any(5) == 0) damaged.resize(any(damaged.size()));
    test::write_bytes(file(), damaged);
    mrpt::Clock::time_point last{};
    const std::string error = test::input_error_of([&] {
      const auto reader = open_recording(file());
      while (const auto observation = reader->next()) {
        EXPECT_GE(observation->timestamp, last);
        last = observation->timestamp;
      }
      ++read_something;
    });
    EXPECT_THAT(error, Not(HasSubstr("\n")));
    refused += !error.empty();
  }
  EXPECT_GT(read_something, 100);
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace rovigo::slam
