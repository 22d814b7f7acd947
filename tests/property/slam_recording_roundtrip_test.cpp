// Random recordings survive every format, and the formats agree with each other.

#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <unistd.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <random>

#include "slam/recording/images.h"
#include "slam/recording/observations.h"
#include "slam/recording/recording.h"
#include "slam/trajectory_evaluation.h"

namespace rovigo::slam {
namespace {

namespace fs = std::filesystem;
using Observations = std::vector<mrpt::obs::CObservation::Ptr>;

class RandomRecording {
 public:
  explicit RandomRecording(std::uint64_t seed) : generator_(seed) {
    info_.name = "random";
    info_.rig.camera.ncols = static_cast<std::uint32_t>(whole(16, 90));
    info_.rig.camera.nrows = static_cast<std::uint32_t>(whole(16, 70));
    info_.rig.camera.setIntrinsicParamsFromValues(real(20, 90), real(20, 90), real(1, 15),
                                                  real(1, 15));
    info_.rig.base_from_camera = base_from_optical(random_pose());
    info_.rig.has_extrinsics = info_.rig.has_imu = info_.rig.has_wheels = true;
    info_.simulation =
        maps::SimulationOrigin{"world", generator_(), {real(-9, 9), real(-9, 9), real(-3, 3)}};
    double time_s = real(0, 2e9);
    observations_.push_back(frame(time_s));  // no recording is without one
    for (int i = whole(5, 60); i > 0; --i) {
      time_s += real(0.001, 0.1);
      observations_.push_back(random_observation(time_s));
    }
  }

  const RecordingInfo& info() const { return info_; }
  const Observations& observations() const { return observations_; }

 private:
  double real(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(generator_); }
  mrpt::poses::CPose3D random_pose() {
    return {real(-1, 1), real(-1, 1), real(-1, 1), real(-3, 3), real(-1.5, 1.5), real(-3, 3)};
  }
  mrpt::obs::CObservation::Ptr random_observation(double time_s) {
    switch (whole(0, 3)) {
      case 0:
        return frame(time_s);
      case 1:
        return make_odometry_observation({time_s, {real(-9, 9), real(-9, 9), real(-3, 3)}},
                                         std::nullopt);
      default:
        return make_imu_observation({time_s,
                                     {real(-3, 3), real(-3, 3), real(-3, 3)},
                                     {real(-20, 20), real(-20, 20), real(-20, 20)}});
    }
  }
  mrpt::obs::CObservation::Ptr frame(double time_s) {
    auto scan = make_rgbd_observation(time_s, info_.rig, 1.0F / 5000);
    const int rows = static_cast<int>(info_.rig.camera.nrows);
    const int columns = static_cast<int>(info_.rig.camera.ncols);
    scan->rangeImage.resize(rows, columns);
    for (int v = 0; v < rows; ++v) {
      for (int u = 0; u < columns; ++u) {
        scan->rangeImage(v, u) = static_cast<std::uint16_t>(whole(0, 65535));
      }
    }
    cv::Mat color(rows, columns, CV_8UC3);
    cv::RNG(generator_()).fill(color, cv::RNG::UNIFORM, 0, 255);
    scan->intensityImage = mrpt::img::CImage(color, mrpt::img::SHALLOW_COPY);
    scan->hasRangeImage = scan->hasIntensityImage = true;
    return scan;
  }

  std::mt19937_64 generator_;
  RecordingInfo info_;
  Observations observations_;
};

Observations read_all(const fs::path& path, RecordingInfo& info) {
  const auto reader = open_recording(path);
  info = reader->info();
  Observations all;
  while (auto observation = reader->next()) all.push_back(observation);
  EXPECT_EQ(reader->skipped(), 0);
  return all;
}

void expect_same(const mrpt::obs::CObservation& a, const mrpt::obs::CObservation& b) {
  ASSERT_EQ(a.GetRuntimeClass(), b.GetRuntimeClass());
  EXPECT_LE(std::abs((a.timestamp - b.timestamp).count()), 3);  // ticks of 100 ns, at 2e9 s
  if (const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&a)) {
    const auto& other = dynamic_cast<const mrpt::obs::CObservation3DRangeScan&>(b);
    EXPECT_EQ(scan->rangeImage, other.rangeImage);
    EXPECT_EQ(color_view(*scan).size(), color_view(other).size());
    EXPECT_EQ(scan->cameraParams.intrinsicParams, other.cameraParams.intrinsicParams);
    EXPECT_LT((scan->sensorPose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>() -
               other.sensorPose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>())
                  .sum_abs(),
              1e-6);
  } else if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&a)) {
    EXPECT_EQ(imu->rawMeasurements,
              dynamic_cast<const mrpt::obs::CObservationIMU&>(b).rawMeasurements);
  } else {
    const auto& pose = dynamic_cast<const mrpt::obs::CObservationOdometry&>(a).odometry;
    const auto& other = dynamic_cast<const mrpt::obs::CObservationOdometry&>(b).odometry;
    EXPECT_NEAR(pose.x(), other.x(), 1e-12);
    EXPECT_NEAR(pose.y(), other.y(), 1e-12);
    EXPECT_NEAR(pose.phi(), other.phi(), 1e-12);
  }
}

class RoundTrip : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(RoundTrip, ThroughRawlogAndTumDirectoryLosesNothing) {
  const fs::path folder =
      fs::temp_directory_path() /
      ("rovigo_roundtrip_" + std::to_string(::getpid()) + "_" + std::to_string(GetParam()));
  fs::create_directory(folder);
  const RandomRecording random(GetParam());
  const auto write = [&](std::unique_ptr<RecordingWriter> writer) {
    for (const auto& observation : random.observations()) writer->write(*observation);
    writer->finish();
  };
  write(create_rawlog(folder / "r.rawlog", random.info()));
  write(create_tum_directory(folder / "tum", random.info()));
  for (const char* name : {"r.rawlog", "tum"}) {
    SCOPED_TRACE(name);
    RecordingInfo info;
    const Observations read = read_all(folder / name, info);
    ASSERT_EQ(read.size(), random.observations().size());
    for (std::size_t i = 0; i < read.size(); ++i) expect_same(*read[i], *random.observations()[i]);
    ASSERT_TRUE(info.simulation);
    EXPECT_EQ(info.simulation->seed, random.info().simulation->seed);
    EXPECT_EQ(info.simulation->world_from_map.x, random.info().simulation->world_from_map.x);
  }
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RoundTrip, ::testing::Range<std::uint64_t>(1, 13));

class RigidMotion : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(RigidMotion, OfTheEstimateChangesNoErrorOfATrajectory) {
  std::mt19937_64 generator(GetParam());
  std::uniform_real_distribution<double> any(-3.0, 3.0);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::vector<StampedPose> truth;
  std::vector<StampedPose> estimate;
  std::vector<StampedPose> moved;
  const mrpt::poses::CPose3D motion(any(generator), any(generator), any(generator), any(generator),
                                    0.4 * any(generator), any(generator));
  mrpt::poses::CPose3D pose;
  for (int i = 0; i < 200; ++i) {
    pose = pose + mrpt::poses::CPose3D(0.03, 0, 0.001, 0.1 * noise(generator), 0, 0);
    truth.push_back({i / 30.0, pose});
    const mrpt::poses::CPose3D error(noise(generator), noise(generator), noise(generator),
                                     noise(generator), 0, 0);
    estimate.push_back({i / 30.0, pose + error});
    moved.push_back({i / 30.0, motion + estimate.back().pose});
  }
  const TrajectoryErrors a = evaluate_trajectory(estimate, truth);
  const TrajectoryErrors b = evaluate_trajectory(moved, truth);
  EXPECT_NEAR(a.ate_rmse_m, b.ate_rmse_m, 1e-9);
  EXPECT_NEAR(a.rpe_translation_m, b.rpe_translation_m, 1e-9);
  EXPECT_NEAR(a.rpe_rotation_rad, b.rpe_rotation_rad, 1e-7);
  EXPECT_NEAR(a.similarity_scale, b.similarity_scale, 1e-9);
  // Alignment can only lower the error of the trajectory as it stands.
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double d = estimate[i].pose.distanceTo(truth[i].pose);
    sum += d * d;
  }
  EXPECT_LE(a.ate_rmse_m, std::sqrt(sum / static_cast<double>(truth.size())) + 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RigidMotion, ::testing::Range<std::uint64_t>(1, 21));

}  // namespace
}  // namespace rovigo::slam
