#include "slam/localizer_depth_check.h"

#include <algorithm>
#include <cmath>

#include "slam/place_match.h"

namespace rovigo::slam {

namespace {

constexpr int kWindowPx = 3;          // landmarks like edges, where depth jumps: look around
constexpr double kDepthGateM = 0.10;  // errors of pose and landmark
constexpr double kDepthGateShare = 0.03;
constexpr double kOwnWallM = 0.3;  // before a landmark: the thing it is on
constexpr double kStepM = 0.05;    // a cell

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

/// Whether an obstacle of the grid lies between the two; one that the landmark itself is on does
/// not count.
bool is_walled_off(const SignedDistanceField& walls, const Eigen::Vector3d& camera,
                   const Eigen::Vector3d& landmark) {
  const Eigen::Vector2d from = camera.head<2>(), way = (landmark - camera).head<2>();
  const double length_m = way.norm();
  double at_m = 0.0;
  while (at_m < length_m - kOwnWallM) {
    const Eigen::Vector2d p = from + way * (at_m / length_m);
    const double wall_m = walls.cell_at({p.x(), p.y()}).wall_m;
    if (wall_m <= 0.0) return true;
    at_m += std::max(kStepM, std::min(wall_m, length_m));  // nothing stands nearer than that
  }
  return false;
}

}  // namespace

DepthAgreement depth_agreement(const LandmarkMap& map, const std::vector<int>& landmarks,
                               const CameraFrame& frame, const Se3& map_from_base, bool on_floor,
                               const SignedDistanceField* walls) {
  DepthAgreement out;
  if (frame.depth.empty()) return out;
  const Se3 map_from_camera = map_from_base * map.base_from_camera();
  const Se3 camera_from_map = map_from_camera.inverse();
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
        out.hidden += !walls || !is_walled_off(*walls, map_from_camera.translation,
                                               map.landmark(l.landmark).position_map);
        break;
      case Verdict::kNone:
        break;
    }
  }
  return out;
}

}  // namespace rovigo::slam
