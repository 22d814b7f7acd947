#include "slam/view_trail.h"

namespace rovigo::slam {

namespace {

constexpr std::size_t kMostViews = 12;  // then it begins anew: a metre or two suffices

}  // namespace

std::optional<Se3> ViewTrail::locate(const SeenView& view, const MotionPrediction& prediction) {
  std::vector<int> tracked;
  for (const FeatureMatch& m : seen_.matches) tracked.push_back(m.landmark);
  local_ = select_local_map(map_, tracked, prediction.prior.map_from_base);
  seen_ = track_frame(map_, local_.landmarks, view.features, prediction);
  if (seen_.status != TrackStatus::kTracked || seen_.solution.degenerate) return std::nullopt;
  return seen_.solution.map_from_base;
}

void ViewTrail::keep(const SeenView& view, const Se3& map_from_base) {
  const bool follows = seen_.status == TrackStatus::kTracked;
  if (follows && !wants_keyframe(map_, local_, seen_, view.features, map_from_base)) return;
  if (!follows || map_.keyframes().size() >= kMostViews) clear();
  Keyframe k;
  k.time_s = view.frame.time_s;
  k.map_from_base = map_from_base;
  k.features = view.features;
  k.landmark_of.assign(k.features.size(), -1);
  for (const FeatureMatch& m : seen_.matches) {
    k.landmark_of[static_cast<std::size_t>(m.feature)] = m.landmark;
  }
  map_.add_keyframe(std::move(k));
}

void ViewTrail::shift(const Se3& new_map_from_old_map) {
  std::vector<Se3> moved;
  for (const Keyframe& k : map_.keyframes()) {
    moved.push_back(new_map_from_old_map * k.map_from_base);
  }
  map_.move_keyframes(moved);
}

void ViewTrail::clear() {
  map_ = LandmarkMap(config_, map_.camera(), map_.base_from_camera());
  local_ = {};
  seen_ = {};
}

}  // namespace rovigo::slam
