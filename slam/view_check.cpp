#include "slam/view_check.h"

#include <algorithm>
#include <cmath>

#include "slam/localizer_depth_check.h"
#include "slam/place_match.h"

namespace rovigo::slam {

namespace {

// A view this near a mapped one has to match it; elsewhere the map knows nothing to contradict.
constexpr double kSameViewM = 0.7, kSameViewRad = 0.45;
// What contradicts a pose: this much to judge by, and this little of it as the map has it.
constexpr int kEnoughLandmarks = 20, kEnoughAtDepth = 60;
constexpr std::size_t kEnoughPoints = 40;
constexpr double kLeastDepthShare = 0.6, kLeastScanShare = 0.5, kLeastMatchedShare = 0.08;

}  // namespace

ViewCheck ViewChecker::check(const SeenView& view, const std::vector<int>& landmarks,
                             const Se3& map_from_base, int inliers) const {
  const DepthAgreement depth =
      depth_agreement(map_, landmarks, view.frame, map_from_base, on_floor_, walls_);
  ViewCheck out;
  if (depth.judged() >= kEnoughLandmarks) out.depth_share = depth.share();
  if (walls_ && view.scan.size() >= kEnoughPoints) {
    out.scan_share = scan_agreement(*walls_, view.scan, to_planar(map_from_base)).share;
  }
  out.matched_share = std::min(1.0, static_cast<double>(inliers) / std::max(1, depth.at_depth));
  out.contradicts = out.depth_share < kLeastDepthShare || out.scan_share < kLeastScanShare ||
                    (depth.at_depth >= kEnoughAtDepth && out.matched_share < kLeastMatchedShare);
  return out;
}

int ViewChecker::telling(const std::vector<FeatureMatch>& matches) const {
  return static_cast<int>(std::count_if(matches.begin(), matches.end(), [&](const auto& m) {
    const bool stands = !on_floor_ || is_upright(map_.landmark(m.landmark));
    return stands && !repeated_[static_cast<std::size_t>(m.landmark)];
  }));
}

bool ViewChecker::map_knows_view(const Se3& map_from_base) const {
  const TPose2D here = to_planar(map_from_base);
  return std::any_of(map_.keyframes().begin(), map_.keyframes().end(), [&](const Keyframe& k) {
    const TPose2D there = to_planar(k.map_from_base);
    return !k.culled() &&
           maps::distance(maps::position_of(here), maps::position_of(there)) < kSameViewM &&
           std::abs(maps::wrap_angle(here.phi - there.phi)) < kSameViewRad;
  });
}

}  // namespace rovigo::slam
