// Rawlogs: ours written and read back, foreign ones of both flavours, and damaged ones.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <opencv2/imgcodecs.hpp>

#include "slam/recording/images.h"
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

void write_foreign(const path& file,
                   const std::vector<mrpt::serialization::CSerializable::Ptr>& all) {
  mrpt::io::CFileGZOutputStream stream(file.string());
  auto archive = mrpt::serialization::archiveFrom(stream);
  for (const auto& object : all) archive << *object;
}

std::string gunzipped(const path& file) {
  std::string bytes;
  char buffer[1 << 16];
  gzFile in = gzopen(file.c_str(), "rb");
  for (int n = gzread(in, buffer, sizeof buffer); n > 0; n = gzread(in, buffer, sizeof buffer)) {
    bytes.append(buffer, static_cast<std::size_t>(n));
  }
  gzclose(in);
  return bytes;
}

class Rawlog : public ::testing::Test {
 protected:
  void SetUp() override {
    written_ = test::test_observations(kFrames);
    test::write_all(*create_rawlog(file(), test::test_info()), written_);
  }
  path file() const { return folder_ / "rec.rawlog"; }

  static constexpr int kFrames = 6;
  test::TemporaryFolder folder_;
  std::vector<mrpt::obs::CObservation::Ptr> written_;
};

TEST_F(Rawlog, ReadsBackEveryObservationInOrder) { test::expect_reads_back(file(), written_); }

TEST_F(Rawlog, KeepsDepthExactlyColourToJpegAndTheSensorPose) {
  const auto read = test::only<CObservation3DRangeScan>(test::read_all(*open_recording(file())));
  const auto written = test::only<CObservation3DRangeScan>(written_);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i]->rangeImage, written[i]->rangeImage);
    EXPECT_EQ(read[i]->rangeUnits, written[i]->rangeUnits);
    EXPECT_TRUE(read[i]->range_is_depth);
    EXPECT_LT((read[i]->sensorPose - written[i]->sensorPose).norm(), 1e-12);
    EXPECT_LT(cv::norm(color_view(*read[i]), color_view(*written[i]), cv::NORM_L1) /
                  static_cast<double>(color_view(*read[i]).total() * 3),
              4.0);
  }
}

TEST_F(Rawlog, KeepsImuAndWheelsExactly) {
  const auto read = test::read_all(*open_recording(file()));
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
    EXPECT_EQ(wheels[i]->odometry, wheels_written[i]->odometry);
  }
}

TEST_F(Rawlog, KeepsRigAndOrigin) {
  const RecordingInfo info = open_recording(file())->info();
  const RecordingInfo expected = test::test_info();
  EXPECT_EQ(info.name, "rec");
  EXPECT_EQ(info.format, "rawlog");
  EXPECT_EQ(info.rig.camera.intrinsicParams, expected.rig.camera.intrinsicParams);
  EXPECT_LT((info.rig.base_from_camera - expected.rig.base_from_camera).norm(), 1e-9);
  EXPECT_TRUE(info.rig.has_extrinsics && info.rig.has_imu && info.rig.has_wheels);
  ASSERT_TRUE(info.simulation);
  EXPECT_EQ(info.simulation->world, "lab");
  EXPECT_EQ(info.simulation->seed, 42U);
  EXPECT_DOUBLE_EQ(info.simulation->world_from_map.x, 1.5);
}

TEST_F(Rawlog, TheSameInputGivesTheSameBytes) {
  test::write_all(*create_rawlog(folder_ / "again.rawlog", test::test_info()), written_);
  EXPECT_EQ(test::read_bytes(file()), test::read_bytes(folder_ / "again.rawlog"));
}

TEST_F(Rawlog, MrptItselfLoadsIt) {
  mrpt::obs::CRawlog rawlog;
  ASSERT_TRUE(rawlog.loadFromRawLogFile(file().string()));
  EXPECT_EQ(rawlog.size(), written_.size());  // the comment is kept apart
  EXPECT_THAT(rawlog.getCommentText(), HasSubstr("\"rovigo\""));
}

TEST_F(Rawlog, AWriterThatIsNotFinishedLeavesNothing) {
  {
    const auto writer = create_rawlog(folder_ / "half.rawlog", test::test_info());
    writer->write(*written_.front());
  }
  int entries = 0;
  for ([[maybe_unused]] const auto& entry : test::fs::directory_iterator(folder_.path())) ++entries;
  EXPECT_EQ(entries, 1);
}

TEST_F(Rawlog, MrptsGlobalImageFlagsAreLeftAsTheyWere) {
  const bool was_disabled = mrpt::img::CImage::DISABLE_JPEG_COMPRESSION();
  const int quality = mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY();
  const auto writer = create_rawlog(folder_ / "x.rawlog", test::test_info());
  writer->write(*written_.at(2));
  EXPECT_EQ(mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(), was_disabled);
  EXPECT_EQ(mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY(), quality);
}

TEST_F(Rawlog, CutAtEveryQuarterGivesWhatStandsBeforeAndAWarning) {
  written_ = test::test_observations(40);
  test::write_all(*create_rawlog(file(), test::test_info()), written_);
  const std::string whole = test::read_bytes(file());
  std::size_t last = 0;
  for (std::size_t quarter = 1; quarter < 4; ++quarter) {
    test::write_bytes(folder_ / "cut.rawlog", whole.substr(0, whole.size() * quarter / 4));
    ::testing::internal::CaptureStderr();
    const auto reader = open_recording(folder_ / "cut.rawlog");
    const auto read = test::read_all(*reader);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    EXPECT_GT(read.size(), last);
    EXPECT_LT(read.size(), written_.size());
    last = read.size();
    EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr("cut.rawlog is cut short after"));
    for (std::size_t i = 0; i < read.size(); ++i) {
      EXPECT_EQ(read[i]->timestamp, written_[i]->timestamp);
    }
  }
}

TEST_F(Rawlog, CutAnywhereItIsReadOrRefusedInOneSentence) {
  const std::string whole = test::read_bytes(file());
  for (std::size_t length = 0; length < whole.size(); length += whole.size() / 61) {
    test::write_bytes(folder_ / "cut.rawlog", whole.substr(0, length));
    try {
      EXPECT_LE(test::read_all(*open_recording(folder_ / "cut.rawlog")).size(), written_.size());
    } catch (const maps::InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

TEST_F(Rawlog, UncompressedAndCutAnywhereToo) {
  const std::string whole = gunzipped(file());
  test::write_bytes(folder_ / "plain.rawlog", whole);
  EXPECT_EQ(test::read_all(*open_recording(folder_ / "plain.rawlog")).size(), written_.size());
  for (std::size_t length = 1; length < whole.size(); length += whole.size() / 97) {
    test::write_bytes(folder_ / "cut.rawlog", whole.substr(0, length));
    try {
      EXPECT_LE(test::read_all(*open_recording(folder_ / "cut.rawlog")).size(), written_.size());
    } catch (const maps::InputError&) {
      SUCCEED();
    }
  }
}

TEST_F(Rawlog, AnyFlippedBitIsSurvivedWithoutAWordOnTheTerminal) {
  const std::string packed = test::read_bytes(file());
  const std::string plain = gunzipped(file());
  for (const std::string* whole : {&packed, &plain}) {
    for (std::size_t i = 0; i < 300; ++i) {
      std::string bytes = *whole;
      const std::size_t at = (i * 7919 + 13) * 31 % bytes.size();
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << i % 8));
      test::write_bytes(folder_ / "bad.rawlog", bytes);
      ::testing::internal::CaptureStderr();
      try {
        EXPECT_LE(test::read_all(*open_recording(folder_ / "bad.rawlog")).size(), written_.size());
      } catch (const maps::InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      }
      EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "byte " << at;
    }
  }
}

TEST_F(Rawlog, ADamagedJpegCostsItsFrameAndNoOther) {
  std::string bytes = gunzipped(file());
  const std::size_t jpeg = bytes.find("\xFF\xD8\xFF", bytes.size() / 2);
  ASSERT_NE(jpeg, std::string::npos);
  const std::size_t table = bytes.find("\xFF\xC4", jpeg);  // a Huffman table
  for (std::size_t i = 4; i < 24; ++i) bytes[table + i] = '\xEE';
  test::write_bytes(folder_ / "bad.rawlog", bytes);
  const auto reader = open_recording(folder_ / "bad.rawlog");
  EXPECT_THAT(test::read_all(*reader), SizeIs(written_.size() - 1));
  EXPECT_EQ(reader->skipped(), 1);
  EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr("colour image"));
}

TEST_F(Rawlog, ImpossibleLengthsAreRefusedBeforeMemoryIsTaken) {
  const std::string whole = gunzipped(file());
  std::string bytes = whole;
  const std::size_t name = bytes.find("CObservationComment") + 19;
  bytes.replace(name + 1, 4, "\xFF\xFF\xFF\xFF");  // after the version: the text's length
  test::write_bytes(folder_ / "bad.rawlog", bytes);
  EXPECT_THAT(test::input_error_of([&] { open_recording(folder_ / "bad.rawlog"); }),
              HasSubstr("not an MRPT rawlog"));
}

TEST_F(Rawlog, EmptyForeignAndMissingFilesAreRefused) {
  test::write_bytes(folder_ / "empty.rawlog", "");
  test::write_bytes(folder_ / "text.rawlog", "this is a letter, not a recording\n");
  test::write_bytes(folder_ / "zeros.rawlog", std::string(10000, '\0'));
  test::write_bytes(folder_ / "ones.rawlog", std::string(10000, '\xff'));
  const auto error = [&](const char* name) {
    return test::input_error_of([&] { open_recording(folder_ / name); });
  };
  EXPECT_THAT(error("empty.rawlog"), HasSubstr("the file is empty"));
  EXPECT_THAT(error("text.rawlog"), HasSubstr("not an MRPT rawlog"));
  EXPECT_THAT(error("zeros.rawlog"), HasSubstr("not an MRPT rawlog"));
  EXPECT_THAT(error("ones.rawlog"), HasSubstr("not an MRPT rawlog"));
  EXPECT_THAT(error("missing.rawlog"), HasSubstr("no such file"));
}

TEST_F(Rawlog, ARosBagIsNamedAsWhatItIs) {
  test::write_bytes(folder_ / "x.bag", "#ROSBAG V2.0\n");
  EXPECT_FALSE(test::input_error_of([&] { open_recording(folder_ / "x.bag"); }).empty());
}

TEST_F(Rawlog, CannotBeWrittenWhereThereIsNoFolder) {
  EXPECT_THAT(
      test::input_error_of([&] { create_rawlog(folder_ / "none/x.rawlog", test::test_info()); }),
      HasSubstr("folder does not exist"));
  EXPECT_THAT(test::input_error_of([&] { create_rawlog(folder_.path(), test::test_info()); }),
              HasSubstr("it is a folder"));
}

TEST_F(Rawlog, ForeignObservationsAreLeftOutAndCounted) {
  const auto laser = mrpt::obs::CObservation2DRangeScan::Create();
  laser->timestamp = timestamp_from_seconds(9.0);
  write_foreign(folder_ / "mixed.rawlog", {laser, test::test_frame(10.0, test::test_rig()), laser});
  const auto reader = open_recording(folder_ / "mixed.rawlog");
  EXPECT_THAT(test::read_all(*reader), SizeIs(1));
  EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr("2 observations of the kind"));
  EXPECT_FALSE(reader->info().rig.has_imu || reader->info().rig.has_wheels);
  EXPECT_TRUE(reader->info().rig.has_extrinsics);
}

TEST_F(Rawlog, OnlyForeignObservationsAreNothingToMap) {
  const auto laser = mrpt::obs::CObservation2DRangeScan::Create();
  laser->timestamp = timestamp_from_seconds(9.0);
  write_foreign(folder_ / "laser.rawlog", {laser, laser});
  EXPECT_THAT(test::input_error_of([&] { open_recording(folder_ / "laser.rawlog"); }),
              HasSubstr("no RGB-D frames"));
}

TEST_F(Rawlog, ActionsAndSensoryFramesBecomeAbsoluteOdometry) {
  std::vector<mrpt::serialization::CSerializable::Ptr> objects;
  for (int i = 0; i < 4; ++i) {
    mrpt::obs::CActionRobotMovement2D movement;
    movement.computeFromOdometry(mrpt::poses::CPose2D(0.5, 0.0, 0.1), {});
    auto actions = mrpt::obs::CActionCollection::Create();
    actions->insert(movement);
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(test::test_frame(10.0 + i, test::test_rig()));
    objects.push_back(actions);
    objects.push_back(frame);
  }
  write_foreign(folder_ / "flavour.rawlog", objects);
  const auto reader = open_recording(folder_ / "flavour.rawlog");
  const auto read = test::read_all(*reader);
  const auto odometry = test::only<CObservationOdometry>(read);
  ASSERT_THAT(odometry, SizeIs(4));
  EXPECT_THAT(test::only<CObservation3DRangeScan>(read), SizeIs(4));
  EXPECT_TRUE(reader->info().rig.has_wheels);
  mrpt::poses::CPose2D sum;
  for (int i = 0; i < 4; ++i) sum = sum + mrpt::poses::CPose2D(0.5, 0.0, 0.1);
  EXPECT_NEAR(odometry[3]->odometry.x(), sum.x(), 1e-9);
  EXPECT_NEAR(odometry[3]->odometry.phi(), sum.phi(), 1e-9);
  EXPECT_DOUBLE_EQ(seconds_of(*odometry[3]), 13.0);
}

TEST_F(Rawlog, ObservationsALittleOutOfOrderAreSorted) {
  std::vector<mrpt::serialization::CSerializable::Ptr> shuffled(written_.begin(), written_.end());
  std::swap(shuffled[3], shuffled[5]);
  std::swap(shuffled[10], shuffled[14]);
  write_foreign(folder_ / "shuffled.rawlog", shuffled);
  const auto read = test::read_all(*open_recording(folder_ / "shuffled.rawlog"));
  ASSERT_EQ(read.size(), written_.size());
  for (std::size_t i = 1; i < read.size(); ++i)
    EXPECT_LE(read[i - 1]->timestamp, read[i]->timestamp);
}

TEST_F(Rawlog, ImagesBesideAForeignRawlogAreLoaded) {
  auto frame = test::test_frame(10.0, test::test_rig());
  test::fs::create_directory(folder_ / "ext_Images");
  const cv::Mat color = color_view(*frame).clone();
  cv::imwrite((folder_ / "ext_Images/color.png").string(), color);
  frame->intensityImage.setExternalStorage("color.png");
  write_foreign(folder_ / "ext.rawlog", {frame});
  const auto read =
      test::only<CObservation3DRangeScan>(test::read_all(*open_recording(folder_ / "ext.rawlog")));
  ASSERT_THAT(read, SizeIs(1));
  EXPECT_EQ(cv::norm(color_view(*read[0]), color, cv::NORM_INF), 0.0);
}

TEST_F(Rawlog, AMissingImageBesideItIsNamed) {
  auto frame = test::test_frame(10.0, test::test_rig());
  frame->intensityImage.setExternalStorage("lost.png");
  write_foreign(folder_ / "ext.rawlog", {frame});
  EXPECT_THAT(test::input_error_of([&] { open_recording(folder_ / "ext.rawlog"); }),
              HasSubstr("lost.png is missing"));
}

TEST_F(Rawlog, AFrameWithoutDepthIsSkippedAndTheRestKept) {
  auto blind = test::test_frame(10.5, test::test_rig());
  blind->hasRangeImage = false;
  write_foreign(folder_ / "some.rawlog", {test::test_frame(10.0, test::test_rig()), blind,
                                          test::test_frame(11.0, test::test_rig())});
  const auto reader = open_recording(folder_ / "some.rawlog");
  EXPECT_THAT(test::read_all(*reader), SizeIs(2));
  EXPECT_EQ(reader->skipped(), 1);
  EXPECT_THAT(test::all_in_one(reader->warnings()), HasSubstr("no depth image"));
}

TEST_F(Rawlog, MrptsOwnRgbdSampleIsReadWithDepthRegisteredToColour) {
  const path sample = "/usr/share/mrpt/datasets/tests_rgbd.rawlog";
  if (!test::fs::exists(sample)) GTEST_SKIP() << sample << " is not here";
  const auto reader = open_recording(sample);
  const auto read = test::only<CObservation3DRangeScan>(test::read_all(*reader));
  ASSERT_THAT(read, SizeIs(1));
  EXPECT_TRUE(read[0]->doDepthAndIntensityCamerasCoincide());
  EXPECT_TRUE(read[0]->cameraParams == read[0]->cameraParamsIntensity);
  EXPECT_EQ(depth_view(*read[0]).size(), color_view(*read[0]).size());
  EXPECT_GT(cv::countNonZero(depth_view(*read[0])), 640 * 480 / 2);
}

}  // namespace
}  // namespace rovigo::slam
