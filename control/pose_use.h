#pragma once
// What a pose is good for: the one rule, for whoever steers and for who watches that.

#include "control/control_config.h"
#include "control/drive_controller.h"

namespace rovigo::control {

enum class PoseUse {
  kDrive,      ///< steer by it
  kLost,       ///< it says that nobody knows where the rover is
  kTooOld,     ///< as if it had not come
  kNotFinite,  ///< likewise
};

/// A pose of the future counts as not finite: its clock makes no sense.
PoseUse judge_pose(const ControlConfig& config, double now_s, const PoseInput& pose);

}  // namespace rovigo::control
