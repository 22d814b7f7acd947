// Real images: TUM freiburg1_rpy, camera only, where the data is at hand.

#include <gtest/gtest.h>

#include <filesystem>

#include "slam/localizer.h"
#include "slam/recording/recording.h"
#include "slam/slam.h"
#include "slam/trajectory_evaluation.h"
#include "tests/support/run_rovigo.h"

namespace rovigo::slam {
namespace {

std::filesystem::path recording_path() {
  return test::test_data() / "recordings" / "tum_freiburg1_rpy_half";
}

struct Mapped {
  maps::SavedMap map;
  SlamSummary summary;
  std::vector<StampedPose> camera_poses;  ///< map_from_camera of every frame
};

Mapped map_frames(int most_frames) {
  const auto reader = open_recording(recording_path());
  Slam slam(SlamConfig{}, reader->info().rig);
  int frames = 0;
  while (const auto observation = reader->next()) {
    slam.process(*observation);
    if (++frames >= most_frames) break;
  }
  Mapped run;
  run.map = slam.finish();
  run.summary = slam.summary();
  for (const maps::StoredPose& p : run.map.trajectory) {
    run.camera_poses.push_back({p.time_s, p.map_from_base + run.map.metadata.base_from_camera});
  }
  return run;
}

class TumFreiburg1Rpy : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(recording_path())) {
      GTEST_SKIP() << "optional data is absent: " << recording_path();
    }
  }
};

TEST_F(TumFreiburg1Rpy, EveryFrameGetsAPoseWithinAFewCentimetres) {
  const Mapped run = map_frames(100000);
  EXPECT_EQ(run.summary.camera_frames, 330);
  EXPECT_EQ(run.camera_poses.size(), 330u);
  EXPECT_GE(run.summary.tracked_frames, 0.95 * run.summary.camera_frames);
  const TrajectoryErrors e = evaluate_trajectory(
      run.camera_poses, read_tum_trajectory(recording_path() / "groundtruth.txt"));
  EXPECT_GE(e.associated, 313);
  EXPECT_LT(e.ate_rmse_m, 0.04);
}

TEST_F(TumFreiburg1Rpy, TheSameFramesTwiceGiveTheSameMapBitForBit) {
  const Mapped a = map_frames(60);
  const Mapped b = map_frames(60);
  ASSERT_EQ(a.map.keyframes.size(), b.map.keyframes.size());
  for (std::size_t i = 0; i < a.map.keyframes.size(); ++i) {
    EXPECT_EQ(a.map.keyframes[i].features, b.map.keyframes[i].features);
    EXPECT_EQ(a.map.keyframes[i].color_jpeg, b.map.keyframes[i].color_jpeg);
    EXPECT_EQ(a.map.keyframes[i].depth_png, b.map.keyframes[i].depth_png);
  }
  EXPECT_EQ(a.map.grid.cells, b.map.grid.cells);
  ASSERT_EQ(a.map.trajectory.size(), b.map.trajectory.size());
  for (std::size_t i = 0; i < a.map.trajectory.size(); ++i) {
    EXPECT_EQ(a.map.trajectory[i].map_from_base, b.map.trajectory[i].map_from_base);
  }
}

TEST_F(TumFreiburg1Rpy, TheCameraFindsItselfInTheMapItMade) {
  const Mapped run = map_frames(60);
  const auto reader = open_recording(recording_path());
  Localizer localizer(SlamConfig{}, reader->info().rig, run.map, std::nullopt);
  int frames = 0, ok = 0;
  while (const auto observation = reader->next()) {
    if (++frames > 60) break;
    const PoseEstimate e = localizer.process(*observation);
    if (e.health != Health::kOk) continue;
    ++ok;
    const auto& mapped = run.map.trajectory[static_cast<std::size_t>(frames) - 1].map_from_base;
    EXPECT_LT(mapped.distanceTo(e.map_from_base), 0.05) << "frame " << frames;
  }
  EXPECT_GT(ok, 45);
}

}  // namespace
}  // namespace rovigo::slam
