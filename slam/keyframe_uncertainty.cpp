#include "slam/keyframe_uncertainty.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

// What one step from keyframe to keyframe adds to the uncertainty, at rest and by its length.
constexpr double kHopM = 0.002, kHopShare = 0.004;
constexpr double kHopRad = 0.001, kHopRadShare = 0.002;

}  // namespace

void spread_uncertainty(const Keyframe& parent, const MotionPrediction& now, bool blind,
                        Keyframe& child) {
  const Se3 step = parent.map_from_base.inverse() * child.map_from_base;
  const double distance = step.translation.norm(), turn = so3_log(step.rotation).norm();
  const double hop_m = kHopM + kHopShare * distance + (blind ? now.sigma_position_m : 0.0);
  const double hop_rad = kHopRad + kHopRadShare * turn + (blind ? now.sigma_heading_rad : 0.0);
  child.sigma_m = std::hypot(parent.sigma_m, hop_m, parent.sigma_rad * distance);
  child.sigma_rad = std::hypot(parent.sigma_rad, hop_rad);
}

void share_certainty(const Keyframe& seen_before, Keyframe& now) {
  now.sigma_m = std::min(now.sigma_m, std::hypot(seen_before.sigma_m, kFoundSigmaM / 5));
  now.sigma_rad = std::min(now.sigma_rad, std::hypot(seen_before.sigma_rad, kFoundSigmaRad / 5));
}

}  // namespace rovigo::slam
