#include "slam/trajectory_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/support/recordings.h"

namespace rovigo::slam {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<StampedPose> some_poses() {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 50; ++i) {
    poses.push_back({1305031229.528748 + i / 30.0,
                     mrpt::poses::CPose3D(0.1 * i, -1.0 / 3.0 * i, 0.01 * i, 0.12 * i - 3.0,
                                          0.02 * i - 0.5, 0.03 * i)});
  }
  return poses;
}

std::string read_error(const std::string& text) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "t.txt", text);
  return test::input_error_of([&] { read_tum_trajectory(folder / "t.txt"); });
}

TEST(TrajectoryFile, ReadsBackWhatItWrote) {
  const test::TemporaryFolder folder;
  write_tum_trajectory(folder / "t.txt", "map_from_base_link", some_poses());
  const auto read = read_tum_trajectory(folder / "t.txt");
  const auto written = some_poses();
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_NEAR(read[i].time_s, written[i].time_s, 3e-7);
    const auto difference = read[i].pose - written[i].pose;
    EXPECT_LT(difference.norm(), 1e-8);
    EXPECT_LT(
        (read[i].pose.getRotationMatrix().asEigen() - written[i].pose.getRotationMatrix().asEigen())
            .norm(),
        1e-7);
  }
}

TEST(TrajectoryFile, NamesItsFrameInTheFirstCommentLine) {
  const test::TemporaryFolder folder;
  write_tum_trajectory(folder / "t.txt", "map_from_base_link", some_poses());
  EXPECT_THAT(test::read_bytes(folder / "t.txt"), StartsWith("# map_from_base_link\n"));
}

TEST(TrajectoryFile, LeavesNothingBehindWhereItCannotWrite) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(test::input_error_of([&] {
                 write_tum_trajectory(folder / "none/t.txt", "map_from_base_link", some_poses());
               }).empty());
  EXPECT_TRUE(test::fs::is_empty(folder.path()));
}

TEST(TrajectoryFile, AcceptsCommentsBlankLinesAndWindowsLineEnds) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "t.txt", "# a\r\n\r\n1 0 0 0 0 0 0 1\r\n\t2  1 2 3 0 0 0 1 \n");
  const auto poses = read_tum_trajectory(folder / "t.txt");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_DOUBLE_EQ(poses[1].pose.z(), 3.0);
}

TEST(TrajectoryFile, NormalisesAQuaternionOfFewDigits) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "t.txt", "1 0 0 0 0.6853 0.5405 -0.0074 -0.4881\n");
  const auto poses = read_tum_trajectory(folder / "t.txt");
  EXPECT_NEAR(poses.at(0).pose.getRotationMatrix().asEigen().determinant(), 1.0, 1e-12);
}

TEST(TrajectoryFile, SaysWhichLineIsWrongAndWhy) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  EXPECT_THAT(read_error(good + "2 0 0 0 0 0 1\n"), HasSubstr("line 2: 7 columns"));
  EXPECT_THAT(read_error(good + "2 0 0 0 0 0 0 1 5\n"), HasSubstr("line 2: 9 columns"));
  EXPECT_THAT(read_error(good + "2 0 nan 0 0 0 0 1\n"), HasSubstr("'nan' in column 3"));
  EXPECT_THAT(read_error(good + "2 0 0 inf 0 0 0 1\n"), HasSubstr("'inf' in column 4"));
  EXPECT_THAT(read_error(good + "2 0 0 1e999 0 0 0 1\n"), HasSubstr("'1e999'"));
  EXPECT_THAT(read_error(good + "2 0 0 1,5 0 0 0 1\n"), HasSubstr("'1,5'"));
  EXPECT_THAT(read_error(good + "0.5 0 0 0 0 0 0 1\n"), HasSubstr("sort the file by time"));
  EXPECT_THAT(read_error(good + "2 0 0 0 0 0 0 0\n"), HasSubstr("quaternion"));
  EXPECT_THAT(read_error(good + "2 0 0 0 1 1 1 1\n"), HasSubstr("quaternion"));
  EXPECT_THAT(read_error(good + "2 1e7 0 0 0 0 0 1\n"), HasSubstr("1e6 m"));
  EXPECT_THAT(read_error("-1 0 0 0 0 0 0 1\n"), HasSubstr("outside 0 .. 1e10"));
  EXPECT_THAT(read_error("1e300 0 0 0 0 0 0 1\n"), HasSubstr("outside 0 .. 1e10"));
  EXPECT_THAT(read_error("# only words\n"), HasSubstr("holds no poses"));
  EXPECT_THAT(read_error(""), HasSubstr("holds no poses"));
}

TEST(TrajectoryFile, ShowsAHostileFieldShortAndPrintable) {
  const std::string message = read_error(std::string(1000, 'x') + "\x1b[31m 0 0 0 0 0 0 1\n");
  EXPECT_LT(message.size(), 300U);
  EXPECT_EQ(message.find('\x1b'), std::string::npos);
}

TEST(TrajectoryFile, EveryTruncationIsReadOrRefusedNeverACrash) {
  const test::TemporaryFolder folder;
  write_tum_trajectory(folder / "t.txt", "map_from_base_link", some_poses());
  const std::string whole = test::read_bytes(folder / "t.txt");
  for (std::size_t length = 0; length < whole.size(); length += 41) {
    test::write_bytes(folder / "cut.txt", whole.substr(0, length));
    try {
      EXPECT_LE(read_tum_trajectory(folder / "cut.txt").size(), 50U);
    } catch (const maps::InputError&) {
      SUCCEED();
    }
  }
}

}  // namespace
}  // namespace rovigo::slam
