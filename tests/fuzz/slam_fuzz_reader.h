#pragma once
// What must hold for any recording, whatever its bytes.

#include <cstdlib>

#include "maps/error.h"
#include "slam/recording/images.h"
#include "slam/recording/recording.h"
#include "slam_fuzz_file.h"

namespace rovigo::slam {

/// Observations in time order, images of the size the rig says, errors of one line.
inline void read_whatever_is_there(const std::filesystem::path& path) {
  try {
    const auto reader = open_recording(path);
    const Rig& rig = reader->info().rig;
    mrpt::Clock::time_point last{};
    while (const auto observation = reader->next()) {
      if (observation->timestamp < last) std::abort();
      last = observation->timestamp;
      const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(observation.get());
      if (scan == nullptr) continue;
      const cv::Size size_px(static_cast<int>(rig.camera.ncols),
                             static_cast<int>(rig.camera.nrows));
      if (color_view(*scan).size() != size_px || depth_view(*scan).size() != size_px) std::abort();
    }
  } catch (const maps::InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) std::abort();
  }
}

}  // namespace rovigo::slam
