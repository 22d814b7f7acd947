#pragma once
// One recording through slam::Slam, as `rovigo map` does it, with what it said on the way.

#include <filesystem>
#include <vector>

#include "maps/map_file.h"
#include "slam/slam.h"

namespace rovigo::test {

struct SlamRun {
  maps::SavedMap map;
  slam::SlamSummary summary;
  std::vector<slam::PoseEstimate>
      answers;  ///< said online, in time order: every frame's, and every change
  std::vector<double> frame_times_s;
  double cpu_ms_per_frame = 0.0;  ///< reading, decoding and the final optimisation included
  double peak_mb = 0.0;           ///< resident, of this process so far
  double first_pose_ms = 0.0;     ///< wall clock, from asking for the first frame to its pose

  /// Resident memory, CPU time spent and keyframes, now and then.
  struct Sample {
    int frames = 0;
    double resident_mb = 0.0;
    double cpu_s = 0.0;
    int keyframes = 0;
  };
  std::vector<Sample> samples;
};

/// Throws InputError as the reader does. One run in a process for a meaningful `peak_mb`.
SlamRun run_slam(const std::filesystem::path& recording);

}  // namespace rovigo::test
