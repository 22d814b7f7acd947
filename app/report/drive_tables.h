#pragma once
// A drive as text files for other tools.

#include <string>

#include "control/drive_log.h"

namespace rovigo::app {

/// One line per control step; poses in the map frame, twists in base_link.
std::string drive_csv(const control::DriveLog& log);

enum class WhichPose { kTrue, kEstimated };

/// TUM format, `t tx ty tz qx qy qz qw`, the frames named in the first comment line. Poses that are
/// not finite are left out.
std::string trajectory_tum(const control::DriveLog& log, WhichPose which);

const char* quality_word(control::PoseQuality quality);

}  // namespace rovigo::app
