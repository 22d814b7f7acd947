#include "app/recording_run.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <sys/resource.h>

#include <algorithm>
#include <ctime>

#include "app/text.h"
#include "slam/heap.h"
#include "slam/trajectory_file.h"

namespace rovigo::app {

namespace {

// Images come and go between what is kept: glibc's heap would grow to more than twice of what is in
// use. Every so many observations what lies free goes back to the system.
constexpr int kTrimEvery = 500;

}  // namespace

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

std::string percent(double share) { return with_unit(100.0 * share, 1, "%"); }

Reading read_all(slam::RecordingReader& reader, const std::string& label, const Console& console,
                 const std::function<void(const mrpt::obs::CObservation&)>& take) {
  Reading reading;
  Progress progress(label);
  const double cpu_before = cpu_seconds();
  int taken = 0;
  while (const auto observation = reader.next()) {
    if (IS_CLASS(*observation, mrpt::obs::CObservation3DRangeScan)) {
      reading.frame_times_s.push_back(mrpt::Clock::toDouble(observation->timestamp));
    }
    take(*observation);
    if (++taken % kTrimEvery == 0) slam::give_back_free_memory();
    progress.update(reader.progress());
  }
  reading.cpu_s = cpu_seconds() - cpu_before;
  reading.warnings = reader.warnings();
  for (const std::string& warning : reading.warnings) console.warn(warning);
  return reading;
}

void write_trajectory(const std::filesystem::path& file,
                      const std::vector<maps::StoredPose>& trajectory, const std::string& frame,
                      const mrpt::poses::CPose3D& base_from_camera) {
  slam::write_tum_trajectory(
      file, "map_from_" + frame, trajectory.size(), [&](std::size_t i) -> slam::StampedPose {
        const maps::StoredPose& p = trajectory[i];
        return {p.time_s, frame == "camera" ? p.map_from_base + base_from_camera : p.map_from_base};
      });
}

double coverage(const std::vector<maps::StoredPose>& poses, double begin_s, double end_s) {
  constexpr double kReachS = 0.02;
  if (end_s <= begin_s) return poses.empty() ? 0.0 : 1.0;
  double covered = 0.0;
  double reached = begin_s;  // everything before is counted
  for (const auto& pose : poses) {
    const double from = std::max(reached, pose.time_s - kReachS);
    const double to = std::min(end_s, pose.time_s + kReachS);
    if (to > from) {
      covered += to - from;
      reached = to;
    }
  }
  return covered / (end_s - begin_s);
}

}  // namespace rovigo::app
