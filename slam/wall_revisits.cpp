#include "slam/wall_revisits.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "slam/local_map.h"
#include "slam/wall_match.h"
#include "slam/wall_ties.h"

namespace rovigo::slam {

namespace {

constexpr double kApartS = 20.0;    // views closer in time hang together by their motion
constexpr double kTogetherS = 5.0;  // views that may be taken for one
constexpr std::size_t kViews = 5;   // at most so many
constexpr double kSpacing = 2.0;    // of the keyframes that are asked, in keyframe spacings
constexpr double kReachM = 6.0;
constexpr int kMinPoints = 40;
constexpr double kMinShare = 0.75;  // of the points that must lie on the walls
// How far the map may have drifted, and what no match may ask for.
constexpr double kDriftM = 0.1, kDriftRad = 0.02, kMostDrifts = 2.0;
// What two views of a wall from two sides err by together: corners cut, depth's own bias.
constexpr double kFloorM = 0.006, kFloorRad = 0.002;

PlacedWalls walls_of(const Keyframe& k) { return {&k.walls, to_planar(k.map_from_base)}; }

bool may_be_asked(const Keyframe& k) { return !k.culled() && !k.walls.empty(); }

struct Overlap {
  int keyframe = -1;
  int points = 0;
};

/// Keyframes long before that see this one's walls.
std::vector<Overlap> overlaps_with(const LandmarkMap& map, const Keyframe& now) {
  std::vector<Overlap> out;
  for (const Keyframe& k : map.keyframes()) {
    if (now.time_s - k.time_s < kApartS) break;
    if (!may_be_asked(k)) continue;
    const double off = (k.map_from_base.translation - now.map_from_base.translation).norm();
    if (off > kReachM) continue;
    const int points = common_points(walls_of(k), walls_of(now));
    if (points >= kMinPoints) out.push_back({k.id, points});
  }
  return out;
}

/// Walls of the keyframe that shows most of them, and of those around it in time.
std::vector<PlacedWalls> reference_of(const LandmarkMap& map, std::vector<Overlap> overlaps,
                                      const Keyframe& best) {
  std::stable_sort(overlaps.begin(), overlaps.end(),
                   [](const Overlap& a, const Overlap& b) { return a.points > b.points; });
  std::vector<PlacedWalls> out;
  for (const Overlap& o : overlaps) {
    const Keyframe& k = map.keyframe(o.keyframe);
    if (std::abs(k.time_s - best.time_s) > kTogetherS || out.size() == kViews) continue;
    out.push_back(walls_of(k));
  }
  return out;
}

bool is_plausible(const WallMatch& match, const TPose2D& prior) {
  const TPose2D& at = match.look.map_from_base;
  return match.points >= kMinPoints && match.inlier_share >= kMinShare &&
         std::hypot(at.x - prior.x, at.y - prior.y) < kMostDrifts * kDriftM &&
         std::abs(maps::wrap_angle(at.phi - prior.phi)) < kMostDrifts * kDriftRad;
}

std::optional<MotionLink> revisit(const LandmarkMap& map, const Keyframe& now) {
  const std::vector<Overlap> overlaps = overlaps_with(map, now);
  if (overlaps.empty()) return std::nullopt;
  const auto most =
      std::max_element(overlaps.begin(), overlaps.end(),
                       [](const Overlap& a, const Overlap& b) { return a.points < b.points; });
  const Keyframe& best = map.keyframe(most->keyframe);
  const Eigen::Matrix3d drift =
      Eigen::Vector3d(kDriftM * kDriftM, kDriftM * kDriftM, kDriftRad * kDriftRad).asDiagonal();
  const TPose2D prior = to_planar(now.map_from_base);
  const WallMatch match = match_walls(reference_of(map, overlaps, best), now.walls, prior, drift);
  if (!is_plausible(match, prior)) return std::nullopt;
  MotionLink link = wall_link(match, best, now);
  link.covariance.diagonal() +=
      Eigen::Vector3d(kFloorM * kFloorM, kFloorM * kFloorM, kFloorRad * kFloorRad);
  return link;
}

}  // namespace

std::vector<MotionLink> wall_revisits(const LandmarkMap& map) {
  std::vector<MotionLink> out;
  const Keyframe* asked = nullptr;
  for (const Keyframe& k : map.keyframes()) {
    if (!may_be_asked(k)) continue;
    if (asked != nullptr &&
        keyframe_spacing(asked->map_from_base, k.map_from_base, map.config().tracking) < kSpacing) {
      continue;
    }
    asked = &k;
    if (const auto link = revisit(map, k)) out.push_back(*link);
  }
  return out;
}

}  // namespace rovigo::slam
