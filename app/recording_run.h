#pragma once
// What every command does that reads a recording from end to end.

#include <functional>
#include <string>
#include <vector>

#include "app/console.h"
#include "maps/map_file.h"
#include "slam/recording/recording.h"

namespace rovigo::app {

/// What reading a whole recording showed, whatever it was read for.
struct Reading {
  std::vector<double> frame_times_s;
  std::vector<std::string> warnings;  ///< of the reader, already shown
  double cpu_s = 0.0;                 ///< reading and decoding included
  double cpu_ms_per_frame(double more_s = 0.0) const {
    return 1e3 * (cpu_s + more_s) /
           static_cast<double>(std::max<std::size_t>(1, frame_times_s.size()));
  }
  double duration_s() const {
    return frame_times_s.empty() ? 0.0 : frame_times_s.back() - frame_times_s.front();
  }
};

/// Hands every observation to `take`, showing progress under `label`; says what the reader warns
/// of.
Reading read_all(slam::RecordingReader& reader, const std::string& label, const Console& console,
                 const std::function<void(const mrpt::obs::CObservation&)>& take);

/// TUM format; `frame` is base_link or camera.
void write_trajectory(const std::filesystem::path& file,
                      const std::vector<maps::StoredPose>& trajectory, const std::string& frame,
                      const mrpt::poses::CPose3D& base_from_camera);

/// Share of the time between first and last camera frame with a pose within 0.02 s.
double coverage(const std::vector<maps::StoredPose>& poses, double begin_s, double end_s);

/// Of this process so far.
double cpu_seconds();
double peak_rss_mb();

std::string percent(double share);

}  // namespace rovigo::app
