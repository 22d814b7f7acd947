// The command line as users and their scripts call it: help, exit codes, one clear sentence.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/run_rovigo.h"

namespace {

using rovigo::test::ProcessResult;
using rovigo::test::run_rovigo;
using rovigo::test::TemporaryFolder;
using rovigo::test::test_data;
using rovigo::test::write_text;
using ::testing::HasSubstr;

const char* const kRoomYaml =
    "image: room.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.196\n";

/// An 8 m x 4 m room with a wall at x = 4 m that has no door; the left half holds a pillar.
void write_walled_room(const std::string& folder) {
  constexpr int kWidth = 160, kHeight = 80;
  std::string cells(kWidth * kHeight, '\xfe');
  const auto block = [&](int x0, int y0, int x1, int y1) {
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) cells[static_cast<std::size_t>(y * kWidth + x)] = '\0';
  };
  block(0, 0, kWidth, 1);
  block(0, kHeight - 1, kWidth, kHeight);
  block(0, 0, 1, kHeight);
  block(kWidth - 1, 0, kWidth, kHeight);
  block(79, 0, 81, kHeight);
  block(40, 36, 44, 44);
  write_text(folder + "/room.pgm", "P5\n160 80\n255\n" + cells);
  write_text(folder + "/room.yaml", kRoomYaml);
}

void expect_one_sentence(const ProcessResult& r, int exit_code) {
  EXPECT_EQ(r.signal, 0);
  EXPECT_EQ(r.exit_code, exit_code) << r.err;
  const std::string& text = exit_code == 2 ? r.err : r.out;
  EXPECT_GT(text.size(), 20u);
  EXPECT_THAT(text, testing::Not(HasSubstr("terminate called")));
  EXPECT_THAT(text, testing::Not(HasSubstr("should not have happened")));
}

TEST(CommandLine, EveryCommandHasHelp) {
  const std::vector<std::vector<std::string>> commands{{},
                                                       {"record"},
                                                       {"map"},
                                                       {"localize"},
                                                       {"info"},
                                                       {"plan"},
                                                       {"drive"},
                                                       {"dock"},
                                                       {"tune"},
                                                       {"identify"},
                                                       {"export"},
                                                       {"import"},
                                                       {"evaluate"},
                                                       {"evaluate", "trajectory"},
                                                       {"evaluate", "map"},
                                                       {"config"}};
  for (auto command : commands) {
    command.push_back("--help");
    const ProcessResult r = run_rovigo(command);
    EXPECT_EQ(r.exit_code, 0);
    EXPECT_THAT(r.out, HasSubstr("--help"));
    EXPECT_THAT(r.out, HasSubstr("Usage"));
  }
}

TEST(CommandLine, BadUsageExitsWithTwoAndSaysWhy) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{},
                                             {"fly"},
                                             {"plan"},
                                             {"plan", "a.rovigo", "--speed", "9"},
                                             {"map", "x.rawlog"},
                                             {"config", "--set"}}) {
    expect_one_sentence(run_rovigo(words), 2);
  }
}

TEST(CommandLine, WithJsonABadInputIsOneObjectOnStdout) {
  const ProcessResult r = run_rovigo({"plan", "/nowhere.rovigo", "--goal", "1,1", "--json"});
  EXPECT_EQ(r.exit_code, 2);
  const auto object = nlohmann::json::parse(r.out);
  EXPECT_EQ(object.at("status"), "bad_input");
  EXPECT_EQ(object.at("code"), 2);
  EXPECT_THAT(object.at("message").get<std::string>(), HasSubstr("/nowhere.rovigo"));
}

TEST(CommandLine, AReferenceSplineThatCutsACornerIsPlannedWithAWarningAndNotDriven) {
  const TemporaryFolder folder;
  std::string map = "type octile\nheight 20\nwidth 20\nmap\n";
  for (int row = 0; row < 20; ++row) {  // a passage one cell wide round a corner
    for (int x = 0; x < 20; ++x) {
      const bool open = (row == 10 && x >= 1 && x <= 15) || (x == 15 && row >= 1 && row <= 10);
      map += open ? '.' : '@';
    }
    map += '\n';
  }
  write_text(folder / "corner.map", map);
  const auto with = [&](const std::string& command, const std::string& mode) {
    return run_rovigo({command, folder / "corner.map", "--start", "1.5,9.5", "--goal", "15.5,18.5",
                       "--set", "planning.spline_mode=" + mode, "--set",
                       "planning.spline_smoothing_cells2=6", "--json"});
  };
  const ProcessResult planned = with("plan", "reference");
  EXPECT_EQ(planned.exit_code, 0);
  EXPECT_GT(nlohmann::json::parse(planned.out).at("unsafe_samples"), 0);
  const ProcessResult driven = with("drive", "reference");
  EXPECT_EQ(driven.exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(driven.out).at("status"), "unsafe_plan");
  EXPECT_EQ(nlohmann::json::parse(with("plan", "safe").out).at("unsafe_samples"), 0);
}

TEST(CommandLine, MissingEmptyTruncatedAndForeignFilesAreRefusedByEveryCommandThatReads) {
  const TemporaryFolder folder;
  write_text(folder / "empty.rovigo", "");
  write_text(folder / "foreign.rovigo", std::string(5000, 'x'));
  write_text(folder / "half.rovigo", "SQLite format 3");
  write_text(folder / "empty.rawlog", "");
  write_text(folder / "foreign.rawlog", "this is no recording\n");
  write_text(folder / "broken.yaml", "image: [");
  for (const std::string name :
       {"missing.rovigo", "empty.rovigo", "foreign.rovigo", "half.rovigo", "broken.yaml"}) {
    SCOPED_TRACE(name);
    const std::string file = folder / name;
    for (const auto& r :
         {run_rovigo({"info", file}), run_rovigo({"plan", file, "--start", "0,0", "--goal", "1,1"}),
          run_rovigo({"drive", file, "--start", "0,0", "--goal", "1,1"}),
          run_rovigo({"export", file, "--format", "ros", "-o", folder / "out.yaml"})}) {
      expect_one_sentence(r, 2);
      EXPECT_THAT(r.err, HasSubstr(name));
    }
  }
  for (const std::string name : {"missing.rawlog", "empty.rawlog", "foreign.rawlog"}) {
    SCOPED_TRACE(name);
    const std::string file = folder / name;
    for (const auto& r :
         {run_rovigo({"info", file}), run_rovigo({"map", file, "-o", folder / "out.rovigo"})}) {
      expect_one_sentence(r, 2);
      EXPECT_THAT(r.err, HasSubstr(name));
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "out.rovigo"));
  }
}

TEST(CommandLine, RefusedGoalsCarryTheirCodes) {
  const TemporaryFolder folder;
  write_walled_room(folder.path().string());
  const std::string map = folder / "room.yaml";
  const auto code_of = [&](const std::string& start, const std::string& goal) {
    const ProcessResult r = run_rovigo({"plan", map, "--start", start, "--goal", goal, "--json"});
    const auto object = nlohmann::json::parse(r.out);
    EXPECT_EQ(r.exit_code, object.at("code") == 0 ? 0 : 1);
    EXPECT_FALSE(object.at("message").get<std::string>().empty());
    return object.at("code").get<int>();
  };
  EXPECT_EQ(code_of("1,2", "3,1"), 0);
  EXPECT_EQ(code_of("-1,2", "3,1"), 203);
  EXPECT_EQ(code_of("1,2", "30,1"), 204);
  EXPECT_EQ(code_of("2.1,2", "3,1"), 205);
  EXPECT_EQ(code_of("1,2", "2.1,2"), 206);
  EXPECT_EQ(code_of("1,2", "6,2"), 208);
}

TEST(CommandLine, ARefusalNamesTheNearestReachableGoal) {
  const TemporaryFolder folder;
  write_walled_room(folder.path().string());
  const ProcessResult r =
      run_rovigo({"plan", folder / "room.yaml", "--start", "1,2", "--goal", "6,2", "--json"});
  const auto nearest = nlohmann::json::parse(r.out).at("nearest_reachable_goal");
  ASSERT_EQ(nearest.size(), 2u);
  EXPECT_LT(nearest[0].get<double>(), 3.70);  // left of the wall, the rover's radius away
  EXPECT_GT(nearest[0].get<double>(), 3.50);
}

TEST(CommandLine, UnknownAndOutOfRangeSettingsAreNamedWithTheNearestValidKey) {
  const TemporaryFolder folder;
  write_text(folder / "c.yaml", "robot:\n  max_sped_m_s: 0.3\n  robot_radius_m: 99\n");
  const ProcessResult r = run_rovigo({"config", "--check", folder / "c.yaml"});
  EXPECT_EQ(r.exit_code, 2);
  EXPECT_THAT(r.err, HasSubstr("line 2"));
  EXPECT_THAT(r.err, HasSubstr("robot.max_speed_m_s"));
  EXPECT_THAT(r.err, HasSubstr("line 3"));
  EXPECT_THAT(r.err, HasSubstr("99"));
  EXPECT_THAT(run_rovigo({"config", "--set", "robot.max_speed_m_s=fast"}).err,
              HasSubstr("not a number"));
}

TEST(CommandLine, BatchAnswersEveryLineInOrder) {
  const TemporaryFolder folder;
  write_walled_room(folder.path().string());
  write_text(folder / "q.csv", "start_x,start_y,goal_x,goal_y\n1,2,3,1\n1,2,6,2\n1,1,3,3\n");
  const ProcessResult r = run_rovigo({"plan", folder / "room.yaml", "--batch", folder / "q.csv"});
  EXPECT_EQ(r.exit_code, 0);
  std::istringstream lines(r.out);
  std::vector<int> codes;
  for (std::string line; std::getline(lines, line);) {
    const auto object = nlohmann::json::parse(line);
    EXPECT_EQ(object.at("index"), codes.size());
    codes.push_back(object.at("code"));
  }
  EXPECT_EQ(codes, (std::vector<int>{0, 208, 0}));
}

TEST(CommandLine, AnImportedMapExportsAndPlansAsItsSource) {
  const TemporaryFolder folder;
  write_walled_room(folder.path().string());
  ASSERT_EQ(run_rovigo({"import", folder / "room.yaml", "-o", folder / "room.rovigo"}).exit_code,
            0);
  ASSERT_EQ(
      run_rovigo({"export", folder / "room.rovigo", "--format", "ros", "-o", folder / "again.yaml"})
          .exit_code,
      0);
  const auto length = [&](const std::string& map) {
    const auto r = run_rovigo({"plan", folder / map, "--start", "1,2", "--goal", "3,1", "--json"});
    return nlohmann::json::parse(r.out).at("path_length_m").get<double>();
  };
  const double original = length("room.yaml");
  EXPECT_EQ(length("room.rovigo"), original);
  EXPECT_EQ(length("again.yaml"), original);
}

TEST(CommandLine, AFailedSaveLeavesTheOldMapWhole) {
  const TemporaryFolder folder;
  write_walled_room(folder.path().string());
  ASSERT_EQ(run_rovigo({"import", folder / "room.yaml", "-o", folder / "room.rovigo"}).exit_code,
            0);
  const std::string before = rovigo::test::read_text(folder / "room.rovigo");
  write_text(folder / "bad.yaml",
             "image: missing.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
             "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  EXPECT_EQ(run_rovigo({"import", folder / "bad.yaml", "-o", folder / "room.rovigo"}).exit_code, 2);
  EXPECT_EQ(rovigo::test::read_text(folder / "room.rovigo"), before);
}

TEST(CommandLine, AnOutputThatCannotBeWrittenIsRefusedBeforeTheWorkBegins) {
  const TemporaryFolder folder;
  write_text(folder / "recording.rawlog", "never read");
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"map", folder / "recording.rawlog", "-o", folder / "missing/map.rovigo"},
           {"map", folder / "recording.rawlog", "-o", folder.path().string()},
           {"record", "--world", "lab", "--route", "lab_short", "-o",
            folder / "missing/r.rawlog"}}) {
    const ProcessResult r = run_rovigo(words);
    expect_one_sentence(r, 2);
    EXPECT_THAT(r.err, HasSubstr("folder"));
  }
}

}  // namespace
