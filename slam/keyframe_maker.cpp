#include "slam/keyframe_maker.h"

#include <algorithm>

#include "slam/keyframe_codec.h"

namespace rovigo::slam {

namespace {

constexpr int kMinFirstFeatures = 50;   // with depth, to start a map on
constexpr double kBlindSpacing = 1.25;  // of keyframes in places that show nothing

}  // namespace

bool frame_joins_map(const LandmarkMap& map, const LocalMap& local, const TrackResult& result,
                     const FeatureSet& features, const Se3& map_from_base,
                     const TrackingHealth& health, bool on_floor) {
  if (map.keyframes().empty()) {
    const auto with_depth = std::count_if(features.features().begin(), features.features().end(),
                                          [](const Feature& f) { return f.depth_m > 0; });
    return on_floor || with_depth >= kMinFirstFeatures;
  }
  if (!health.is_trusted()) return false;
  if (result.status == TrackStatus::kTracked) {
    return wants_keyframe(map, local, result, features, map_from_base);
  }
  if (!on_floor) return false;
  const Se3& last = map.keyframes().back().map_from_base;
  return keyframe_spacing(last, map_from_base, map.config().tracking) > kBlindSpacing;
}

Keyframe make_keyframe(const CameraFrame& frame, FeatureSet features,
                       const std::vector<FeatureMatch>& matches, const Se3& map_from_base) {
  Keyframe k;
  k.time_s = frame.time_s;
  k.color_jpeg = encode_color(frame.color);
  k.depth_png = encode_depth(frame);
  k.map_from_base = map_from_base;
  k.features = std::move(features);
  k.landmark_of.assign(k.features.size(), -1);
  for (const FeatureMatch& m : matches) {
    k.landmark_of[static_cast<std::size_t>(m.feature)] = m.landmark;
  }
  return k;
}

}  // namespace rovigo::slam
