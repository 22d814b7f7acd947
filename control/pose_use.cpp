#include "control/pose_use.h"

#include <cmath>

namespace rovigo::control {

PoseUse judge_pose(const ControlConfig& config, double now_s, const PoseInput& pose) {
  constexpr double kClockSlackS = 0.05;  // poses may be stamped at the end of the present step
  const double age = now_s - pose.time_s;
  if (!maps::is_finite(pose.map_from_base) || !(age >= -kClockSlackS)) return PoseUse::kNotFinite;
  if (!(age <= config.max_pose_age_s)) return PoseUse::kTooOld;
  if (pose.quality == PoseQuality::kGood) return PoseUse::kDrive;
  const bool good_enough = pose.quality == PoseQuality::kDoubtful &&
                           pose.sigma_position_m <= config.max_doubtful_sigma_m;
  return good_enough ? PoseUse::kDrive : PoseUse::kLost;
}

}  // namespace rovigo::control
