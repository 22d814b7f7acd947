#include "slam/localizer_depth_check.h"

#include <cmath>

#include "slam/place_match.h"

namespace rovigo::slam {

namespace {

constexpr int kWindowPx = 3;          // landmarks like edges, where depth jumps: look around
constexpr double kDepthGateM = 0.10;  // errors of pose and landmark
constexpr double kDepthGateShare = 0.03;

enum class Verdict { kNone, kThere, kSeenThrough, kHidden };

Verdict judge(const CameraFrame& frame, const Eigen::Vector2d& raw_pixel, double expected_m) {
  const int u = static_cast<int>(std::lround(raw_pixel.x()));
  const int v = static_cast<int>(std::lround(raw_pixel.y()));
  const double gate = kDepthGateM + kDepthGateShare * expected_m;
  bool nearer = false, farther = false;
  for (int dv = -kWindowPx; dv <= kWindowPx; dv += kWindowPx) {
    for (int du = -kWindowPx; du <= kWindowPx; du += kWindowPx) {
      const int x = u + du, y = v + dv;
      if (x < 0 || y < 0 || x >= frame.depth.cols || y >= frame.depth.rows) continue;
      const auto raw = frame.depth.at<std::uint16_t>(y, x);
      if (raw == 0) continue;
      const double z = raw * frame.depth_unit_m;
      if (std::abs(z - expected_m) <= gate) return Verdict::kThere;
      (z < expected_m ? nearer : farther) = true;
    }
  }
  if (nearer) return Verdict::kHidden;
  return farther ? Verdict::kSeenThrough : Verdict::kNone;
}

}  // namespace

DepthAgreement depth_agreement(const LandmarkMap& map, const std::vector<int>& landmarks,
                               const CameraFrame& frame, const Se3& map_from_base, bool on_floor) {
  DepthAgreement out;
  if (frame.depth.empty()) return out;
  const Se3 camera_from_map = (map_from_base * map.base_from_camera()).inverse();
  for (const VisibleLandmark& l : visible_landmarks(map, landmarks, map_from_base)) {
    // The floor is where it is at every place.
    if (on_floor && !is_upright(map.landmark(l.landmark))) continue;
    const double expected_m = (camera_from_map * map.landmark(l.landmark).position_map).z();
    switch (judge(frame, map.camera().distort(l.pixel), expected_m)) {
      case Verdict::kThere:
        ++out.at_depth;
        break;
      case Verdict::kSeenThrough:
        ++out.seen_through;
        break;
      case Verdict::kHidden:
        ++out.hidden;
        break;
      case Verdict::kNone:
        break;
    }
  }
  return out;
}

}  // namespace rovigo::slam
