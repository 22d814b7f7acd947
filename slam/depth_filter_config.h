#pragma once
// Which depth filters run, without OpenCV's headers: every settings reader includes it.

#include "maps/settings.h"

namespace rovigo::slam {

/// Which of them run before a depth image is used for the grid. The defaults are what measurably
/// helps there.
struct DepthFilterConfig {
  int depth_decimation = 1;
  bool depth_spatial_filter = false;
  bool depth_temporal_filter = false;
  int depth_hole_filling_px = 0;

  void describe(maps::SettingsVisitor& v);
};

}  // namespace rovigo::slam
