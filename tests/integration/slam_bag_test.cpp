// A recording as a bag is the same recording: `rovigo` maps it to the same poses.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "slam/recording/recording.h"
#include "slam/trajectory_file.h"
#include "tests/support/bag_recording.h"
#include "tests/support/run_rovigo.h"

namespace rovigo {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The first `seconds` of a recording as a bag. Simulated depth is kept exactly by 32FC1.
void convert_to_bag(const std::string& rawlog, const std::string& bag, double seconds) {
  const auto reader = slam::open_recording(rawlog);
  slam::test::BagRecorder recorder(bag, slam::test::BagStyle::kTum, test::BagCompression::kLz4,
                                   reader->info());
  double first_s = 0.0;
  while (const auto observation = reader->next()) {
    const double time_s = mrpt::Clock::toDouble(observation->timestamp);
    if (first_s == 0.0) first_s = time_s;
    if (time_s - first_s > seconds) break;
    recorder.write(*observation);
  }
  recorder.finish();
}

TEST(BagOfASimulatedRecording, IsDescribedMappedAndLocalisedAsTheRawlogIs) {
  const test::TemporaryFolder folder;
  const std::string rawlog = folder / "r.rawlog";
  const std::string bag = folder / "r.bag";
  const auto recorded = test::run_rovigo({"record", "--world", "lab", "--route", "lab_short",
                                          "--seed", "5", "--fps", "10", "-o", rawlog});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  convert_to_bag(rawlog, bag, 1e9);

  const auto described = test::run_rovigo({"info", bag, "--json"});
  ASSERT_EQ(described.exit_code, 0) << described.err;
  const auto info = nlohmann::json::parse(described.out);
  EXPECT_EQ(info["format"], "bag");
  EXPECT_THAT(info["warnings"], IsEmpty());
  EXPECT_EQ(info["sources"]["wheels"], "/odom");
  EXPECT_EQ(info["skipped_frames"], 0);

  std::vector<std::vector<slam::StampedPose>> trajectories;
  for (const std::string& recording : {rawlog, bag}) {
    const std::string poses = recording + ".txt";
    const auto mapped = test::run_rovigo(
        {"map", recording, "-o", recording + ".rovigo", "--trajectory", poses, "--json"});
    ASSERT_EQ(mapped.exit_code, 0) << mapped.err;
    trajectories.push_back(slam::read_tum_trajectory(poses));
  }
  ASSERT_EQ(trajectories[0].size(), trajectories[1].size());
  double furthest_m = 0.0;
  for (std::size_t i = 0; i < trajectories[0].size(); ++i) {
    EXPECT_EQ(trajectories[0][i].time_s, trajectories[1][i].time_s);
    furthest_m = std::max(furthest_m, trajectories[0][i].pose.distanceTo(trajectories[1][i].pose));
  }
  EXPECT_LT(furthest_m, 0.002);  // the extrinsics went through a quaternion

  const auto localized = test::run_rovigo({"localize", rawlog + ".rovigo", bag, "--json"});
  EXPECT_EQ(localized.exit_code, 0) << localized.out << localized.err;
}

TEST(BagThatIsNone, IsRefusedInOneSentence) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "x.bag", "not a bag");
  for (const char* command : {"info", "map"}) {
    std::vector<std::string> arguments = {command, folder / "x.bag"};
    if (std::string(command) == "map")
      arguments.insert(arguments.end(), {"-o", folder / "m.rovigo"});
    const auto result = test::run_rovigo(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("not a ROS 1 bag"));
  }
}

}  // namespace
}  // namespace rovigo
