#pragma once
// Small recordings for the tests: 64 x 48 pixels, a known texture, a slanted wall, IMU and wheels.

#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "maps/error.h"
#include "slam/recording/observations.h"
#include "slam/recording/recording.h"

namespace rovigo::slam::test {

namespace fs = std::filesystem;

/// A folder of its own for each test, removed with what is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "rovigo_recording_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

inline void write_bytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string read_bytes(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The message of the InputError that `action` throws; empty when it throws none.
inline std::string input_error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const maps::InputError& error) {
    return error.what();
  }
  return {};
}

inline Rig test_rig() {
  Rig rig;
  rig.camera.ncols = 64;
  rig.camera.nrows = 48;
  rig.camera.setIntrinsicParamsFromValues(55.25, 54.75, 31.5, 24.125);
  rig.base_from_camera =
      base_from_optical(mrpt::poses::CPose3D(0.12, 0.02, 0.25, 0.01, 0.03, -0.02));
  rig.has_extrinsics = rig.has_wheels = rig.has_imu = true;
  return rig;
}

inline RecordingInfo test_info() {
  RecordingInfo info;
  info.name = "test";
  info.rig = test_rig();
  info.simulation = maps::SimulationOrigin{"lab", 42, {1.5, -2.25, 0.3}};
  return info;
}

inline mrpt::obs::CObservation3DRangeScan::Ptr test_frame(double time_s, const Rig& rig,
                                                          float units_m = 1.0F / 5000) {
  auto scan = make_rgbd_observation(time_s, rig, units_m);
  const int rows = static_cast<int>(rig.camera.nrows);
  const int columns = static_cast<int>(rig.camera.ncols);
  cv::Mat color(rows, columns, CV_8UC3);
  scan->rangeImage.resize(rows, columns);
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < columns; ++u) {
      const auto shade = [&](double phase) {
        return static_cast<uchar>(128 + 100 * std::sin(0.15 * u + 0.1 * v + phase + time_s));
      };
      color.at<cv::Vec3b>(v, u) = {shade(0.0), shade(1.0), shade(2.0)};
      const double depth_m = 1.0 + 0.02 * u + 0.013 * v;
      const bool has_return = (u + v) % 7 != 0;
      scan->rangeImage(v, u) =
          has_return ? static_cast<std::uint16_t>(std::lround(depth_m / units_m)) : 0;
    }
  }
  scan->hasRangeImage = scan->hasIntensityImage = true;
  scan->intensityImage = mrpt::img::CImage(color, mrpt::img::SHALLOW_COPY);
  return scan;
}

inline ImuSample test_imu(double time_s) {
  return {time_s, {0.1 + time_s, -1.0 / 3.0, 0.02}, {0.3, -0.1, 9.81 + 1e-7 * time_s}};
}

inline WheelSample test_wheels(double time_s) {
  return {time_s, {0.4 * time_s, 0.01 / 3.0 * time_s, 0.3 * time_s}};
}

/// `frames` camera frames at 15 Hz with IMU at 60 Hz and wheels at 30 Hz in between, in time order.
inline std::vector<mrpt::obs::CObservation::Ptr> test_observations(int frames) {
  std::vector<mrpt::obs::CObservation::Ptr> all;
  const Rig rig = test_rig();
  std::optional<WheelSample> previous;
  for (int tick = 0; tick < frames * 4; ++tick) {
    const double time_s = 10.0 + tick / 60.0;
    if (tick % 2 == 0) {
      const WheelSample wheels = test_wheels(time_s);
      all.push_back(make_odometry_observation(wheels, previous));
      previous = wheels;
    }
    all.push_back(make_imu_observation(test_imu(time_s)));
    if (tick % 4 == 0) all.push_back(test_frame(time_s, rig));
  }
  return all;
}

inline void write_all(RecordingWriter& writer,
                      const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
  for (const auto& observation : observations) writer.write(*observation);
  writer.finish();
}

inline std::vector<mrpt::obs::CObservation::Ptr> read_all(RecordingReader& reader) {
  std::vector<mrpt::obs::CObservation::Ptr> all;
  while (auto observation = reader.next()) all.push_back(observation);
  return all;
}

/// Times and kinds of what a recording gives are those of what was written, and nothing is amiss.
inline void expect_reads_back(const fs::path& path,
                              const std::vector<mrpt::obs::CObservation::Ptr>& written) {
  const auto reader = open_recording(path);
  const auto read = read_all(*reader);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i]->timestamp, written[i]->timestamp) << "observation " << i;
    EXPECT_EQ(read[i]->GetRuntimeClass(), written[i]->GetRuntimeClass()) << "observation " << i;
  }
  EXPECT_EQ(reader->skipped(), 0);
  EXPECT_TRUE(reader->warnings().empty()) << reader->warnings().front();
  EXPECT_DOUBLE_EQ(reader->progress(), 1.0);
}

template <class T>
std::vector<std::shared_ptr<T>> only(const std::vector<mrpt::obs::CObservation::Ptr>& all) {
  std::vector<std::shared_ptr<T>> some;
  for (const auto& observation : all) {
    if (auto one = std::dynamic_pointer_cast<T>(observation)) some.push_back(one);
  }
  return some;
}

inline std::string all_in_one(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += sentence + "\n";
  return text;
}

}  // namespace rovigo::slam::test
