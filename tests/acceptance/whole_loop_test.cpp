// The main job, small: record a few metres of the lab, map them, evaluate, plan, drive, repeat.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "tests/support/run_rovigo.h"

namespace {

using rovigo::test::ProcessResult;
using rovigo::test::read_text;
using rovigo::test::run_rovigo;
using rovigo::test::TemporaryFolder;

nlohmann::json run_json(std::vector<std::string> words) {
  words.push_back("--json");
  const ProcessResult r = run_rovigo(words);
  EXPECT_EQ(r.exit_code, 0) << words[0] << ": " << r.err << r.out;
  return nlohmann::json::parse(r.out, nullptr, false);
}

/// The same command in this process.
nlohmann::json run_here(std::vector<std::string> words) {
  words.insert(words.begin(), "rovigo");
  words.push_back("--json");
  std::vector<const char*> argv;
  for (const auto& word : words) argv.push_back(word.c_str());
  testing::internal::CaptureStdout();
  const int code = rovigo::app::run_command_line(static_cast<int>(argv.size()), argv.data());
  const std::string out = testing::internal::GetCapturedStdout();
  EXPECT_EQ(code, 0) << out;
  return nlohmann::json::parse(out, nullptr, false);
}

TEST(WholeLoop, RecordsMapsEvaluatesPlansDrivesAndRepeats) {
  const TemporaryFolder folder;
  const std::string rawlog = folder / "lab.rawlog", map = folder / "lab.rovigo";

  const auto record =
      run_json({"record", "--world", "lab", "--route", "lab_short", "--seed", "3", "--fps", "15",
                "-o", rawlog, "--tum", folder / "tum", "--truth", folder / "truth"});
  EXPECT_EQ(record.at("collisions"), 0);

  const auto mapped = run_json({"map", rawlog, "-o", map, "--trajectory", folder / "t.txt"});
  EXPECT_GE(mapped.at("coverage"), 0.99);
  EXPECT_GE(mapped.at("tracked_fraction"), 0.95);
  const auto ate =
      run_json({"evaluate", "trajectory", folder / "t.txt", folder / "truth/base_groundtruth.txt"});
  EXPECT_LE(ate.at("ate_rmse_m"), 0.05);
  const auto grid = run_json({"evaluate", "map", map, folder / "truth/world_grid.yaml"});
  EXPECT_GE(grid.at("precision"), 0.90);
  EXPECT_GE(grid.at("recall"), 0.85);

  // The TUM directory beside the rawlog holds the same drive.
  const auto tum = run_json(
      {"map", folder / "tum", "-o", folder / "tum.rovigo", "--trajectory", folder / "u.txt"});
  EXPECT_EQ(tum.at("frames"), mapped.at("frames"));
  EXPECT_LE(
      run_json({"evaluate", "trajectory", folder / "u.txt", folder / "truth/base_groundtruth.txt"})
          .at("ate_rmse_m"),
      0.05);

  // Mapping again gives the same bytes.
  run_json({"map", rawlog, "-o", folder / "again.rovigo"});
  EXPECT_TRUE(read_text(map) == read_text(folder / "again.rovigo")) << "the two maps differ";

  // Drive to where the recording ended; pose from SLAM, errors on truth.
  const std::string trajectory = read_text(folder / "t.txt");
  const std::size_t last_line = trajectory.rfind('\n', trajectory.size() - 2) + 1;
  std::istringstream last(trajectory.substr(last_line));
  double t = 0, x = 0, y = 0;
  last >> t >> x >> y;
  const std::string goal = std::to_string(x) + "," + std::to_string(y);
  const std::vector<std::string> drive{"drive",  map, "--goal",   goal,
                                       "--seed", "5", "--report", folder / "report"};
  const auto first = run_json(drive);
  EXPECT_EQ(first.at("collisions"), 0);
  EXPECT_LE(first.at("cross_track_rms_m"), 0.03);
  EXPECT_LE(first.at("final_position_error_m"), 0.05);
  for (const std::string file :
       {"index.html", "map.png", "drive.json", "drive.csv", "trajectory.csv"}) {
    EXPECT_GT(read_text(folder / ("report/" + file)).size(), 100u) << file;
  }

  // The same command and seed: the same hash in another process and twice in this one.
  EXPECT_EQ(run_json(drive).at("log_hash"), first.at("log_hash"));
  EXPECT_EQ(run_here(drive).at("log_hash"), first.at("log_hash"));
  EXPECT_EQ(run_here(drive).at("log_hash"), first.at("log_hash"));
}

TEST(WholeLoop, TheSameSeedRecordsTheSameBytes) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "again");
  const auto record = [&](const std::string& file, const std::string& seed) {
    run_json({"record", "--world", "lab", "--route", "lab_short", "--seed", seed, "--fps", "2",
              "-o", folder / file});
  };
  record("a.rawlog", "3");
  record("again/a.rawlog", "3");  // the same name: a recording knows its own
  record("c.rawlog", "4");
  EXPECT_TRUE(read_text(folder / "a.rawlog") == read_text(folder / "again/a.rawlog"));
  EXPECT_FALSE(read_text(folder / "a.rawlog") == read_text(folder / "c.rawlog"));
}

}  // namespace
