#include "app/report/drive_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "app/report/drive_page.h"
#include "app/report/drive_tables.h"
#include "maps/error.h"

namespace rovigo::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class ReportFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    dir = std::filesystem::temp_directory_path() /
          ("rovigo_report_" + std::to_string(::getpid()) + "_" + test->name());
    std::filesystem::remove_all(dir);
  }
  void TearDown() override { std::filesystem::remove_all(dir); }
  std::string content(const std::string& name) const {
    std::ifstream in(dir / name, std::ios::binary);
    EXPECT_TRUE(in) << name;
    std::ostringstream s;
    s << in.rdbuf();
    return s.str();
  }
  std::filesystem::path dir;
};

/// One metre straight ahead, driven one centimetre to the left of the plan.
DriveReportInput sample_input() {
  DriveReportInput in;
  in.title = "Drive <to> the goal";
  in.summary = "Reached.";
  in.command = "rovigo drive lab.rovigo --goal 1,0";
  in.succeeded = true;
  in.grid = maps::OccupancyGrid({0.05, {-1, -1}, 60, 40}, maps::OccupancyGrid::kFree);
  for (int i = 0; i <= 100; ++i) {
    planning::TrajectoryPoint p;
    p.time_s = 0.05 * i;
    p.pose = {0.01 * i, 0, 0};
    p.speed_m_s = i == 0 || i == 100 ? 0.0 : 0.2;
    in.planned.points.push_back(p);
    control::DriveStep s;
    s.time_s = p.time_s;
    s.reference = p;
    s.true_pose = {0.01 * i, 0.01, 0};
    s.estimated_pose = s.true_pose;
    s.quality = i < 5    ? control::PoseQuality::kLost
                : i < 40 ? control::PoseQuality::kGood
                         : control::PoseQuality::kDoubtful;
    s.command.vx = p.speed_m_s;
    in.log.steps.push_back(s);
  }
  in.log.status = control::TrackStatus::kReached;
  in.metrics = control::measure(in.log, in.planned, {1, 0, 0}, false);
  in.checks = {{"Good figure", 0.01, 0.02, "m"},
               {"Bad figure", 0.03, 0.02, "m"},
               {"Unknown figure", std::numeric_limits<double>::quiet_NaN(), 1.0, ""}};
  in.facts = {{"World", "lab"}};
  in.drive_json = "{\"status\":\"ok\"}";
  return in;
}

TEST_F(ReportFolder, HoldsEverythingItPromises) {
  write_drive_report(dir, sample_input());
  for (const char* name :
       {"index.html", "map.png", "drive.json", "trajectory.csv", "drive.csv", "trajectory_true.txt",
        "trajectory_estimated.txt", "heading_error.svg", "position_error.svg", "speed.svg",
        "turn_rate.svg", "estimate_error.svg"}) {
    EXPECT_FALSE(content(name).empty()) << name;
  }
  EXPECT_EQ(content("drive.json"), "{\"status\":\"ok\"}\n");
}

TEST_F(ReportFolder, PageNeedsNoNetworkAndNoScript) {
  write_drive_report(dir, sample_input());
  std::string page = content("index.html");
  const std::string name_space = "http://www.w3.org/2000/svg";  // a name, never fetched
  for (auto at = page.find(name_space); at != std::string::npos; at = page.find(name_space)) {
    page.erase(at, name_space.size());
  }
  for (const char* word : {"http:", "https:", "<script", "<link", "@import", "url("}) {
    EXPECT_THAT(page, Not(HasSubstr(word)));
  }
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,iVBOR"));
}

TEST_F(ReportFolder, PageMarksWhatPassedAndEscapesWords) {
  write_drive_report(dir, sample_input());
  const std::string page = content("index.html");
  EXPECT_THAT(page, HasSubstr("Drive &lt;to&gt; the goal"));
  const auto mark_after = [&](const std::string& name) {
    const auto at = page.find("<td>" + name);
    return page.substr(at, page.find("</tr>", at) - at);
  };
  EXPECT_THAT(mark_after("Good figure"), HasSubstr("pass"));
  EXPECT_THAT(mark_after("Bad figure"), HasSubstr("fail"));
  EXPECT_THAT(mark_after("Unknown figure"), HasSubstr("fail"));
  EXPECT_THAT(page, HasSubstr("10.0 mm"));  // the cross-track error
  EXPECT_THAT(page, HasSubstr("pose doubtful"));
}

TEST_F(ReportFolder, EveryFileThePageLinksToIsThere) {
  write_drive_report(dir, sample_input());
  const std::string page = content("index.html");
  int links = 0;
  const std::string mark = "href=\"";
  for (auto at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1)) {
    const auto from = at + mark.size();
    EXPECT_TRUE(std::filesystem::exists(dir / page.substr(from, page.find('"', from) - from)));
    ++links;
  }
  EXPECT_GE(links, 10);
}

TEST_F(ReportFolder, SameInputSameBytes) {
  write_drive_report(dir, sample_input());
  const std::string first = content("index.html");
  write_drive_report(dir, sample_input());
  EXPECT_EQ(content("index.html"), first);
}

TEST_F(ReportFolder, SurvivesADriveThatNeverBegan) {
  DriveReportInput in = sample_input();
  in.log.steps.clear();
  in.planned.points.clear();
  in.metrics = {};
  EXPECT_NO_THROW(write_drive_report(dir, in));
}

TEST_F(ReportFolder, RefusesAFolderThatIsAFile) {
  std::ofstream(dir) << "in the way";
  EXPECT_THROW(write_drive_report(dir, sample_input()), maps::InputError);
}

TEST(DriveTables, PathHasTheContractsColumns) {
  const std::string csv = path_csv(sample_input().planned);
  EXPECT_THAT(csv, StartsWith("t_s,x_m,y_m,yaw_rad,v_m_s,w_rad_s,curvature_1_m\n"
                              "0.000000,0.000000,0.000000,0.000000,0.000000,0.000000,0.000000\n"));
}

TEST(DriveTables, EveryLineOfTheDriveHasAsManyFieldsAsTheHeader) {
  std::istringstream lines(drive_csv(sample_input().log));
  std::string line;
  std::getline(lines, line);
  const auto commas = std::count(line.begin(), line.end(), ',');
  int rows = 0;
  for (; std::getline(lines, line); ++rows) {
    ASSERT_EQ(std::count(line.begin(), line.end(), ','), commas) << line;
  }
  EXPECT_EQ(rows, 101);
}

TEST(DriveTables, TumLinesHaveEightColumnsAndAUnitQuaternion) {
  control::DriveLog log = sample_input().log;
  log.steps[3].true_pose = {1, 2, 2.5};
  log.steps[4].true_pose.x = std::numeric_limits<double>::quiet_NaN();  // left out
  std::istringstream lines(trajectory_tum(log, WhichPose::kTrue));
  std::string line;
  std::getline(lines, line);
  EXPECT_THAT(line, StartsWith("# map_from_base_link"));
  int rows = 0;
  while (std::getline(lines, line)) {
    std::istringstream numbers(line);
    double v[8];
    for (double& x : v) ASSERT_TRUE(numbers >> x) << line;
    std::string rest;
    EXPECT_FALSE(numbers >> rest);
    EXPECT_NEAR(v[4] * v[4] + v[5] * v[5] + v[6] * v[6] + v[7] * v[7], 1.0, 1e-6);
    if (rows == 3) {
      EXPECT_NEAR(2 * std::atan2(v[6], v[7]), 2.5, 1e-6);
    }
    ++rows;
  }
  EXPECT_EQ(rows, 100);
}

TEST(Base64, FollowsTheRfc) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

}  // namespace
}  // namespace rovigo::app
