#include "app/track/drive_series.h"

#include <gtest/gtest.h>

#include "maps/error.h"
#include "tests/support/run_rovigo.h"

namespace rovigo::app {
namespace {

TrackRun some_run() {
  TrackRun run;
  run.what.name = "g/t/default/0.400";
  for (int i = 0; i < 120; ++i) {
    control::DriveStep step;
    step.time_s = i / 120.0;
    step.true_pose = {0.00001 * i, 0.0, 0.0};
    run.log.steps.push_back(step);
  }
  planning::Trajectory plan;  // a metre along x in a second
  plan.points.resize(2);
  plan.points[1].time_s = 1.0;
  plan.points[1].pose.x = 1.0;
  run.track = std::make_shared<const PlannedTrack>(
      PlannedTrack{sim::World::random_office(1), std::move(plan), {}});
  return run;
}

TEST(DriveSeries, TenSamplesASecondComeBackAsTheyWereWritten) {
  const DriveSeries series = series_of(some_run());
  EXPECT_EQ(series.time_s.size(), 10U);
  const test::TemporaryFolder folder;
  const std::string text = series_json({series, series}).dump();
  test::write_text(folder / "drives.json", text);
  const auto again = read_series(folder / "drives.json");
  ASSERT_EQ(again.size(), 2U);
  EXPECT_EQ(series_json(again).dump(), text);
}

TEST(DriveSeries, DamagedFilesAreRefused) {
  const test::TemporaryFolder folder;
  auto list = series_json({series_of(some_run())});
  const std::string good = list.dump();
  for (std::size_t n = 0; n < good.size(); n += 29) {
    test::write_text(folder / "cut", good.substr(0, n));
    EXPECT_THROW(read_series(folder / "cut"), maps::InputError) << n;
  }
  list[0]["x_m"].erase(0);
  test::write_text(folder / "short", list.dump());
  EXPECT_THROW(read_series(folder / "short"), maps::InputError);
}

}  // namespace
}  // namespace rovigo::app
