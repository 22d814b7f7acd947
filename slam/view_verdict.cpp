#include "slam/view_verdict.h"

#include "slam/localizer_depth_check.h"

namespace rovigo::slam {

namespace {

constexpr int kTellingLandmarks = 40;   // that should be in view: fewer prove nothing
constexpr double kAgreeingShare = 0.5;  // of them that must be at their depth

}  // namespace

ViewVerdict view_verdict(const LandmarkMap& map, const std::vector<int>& landmarks,
                         const CameraFrame& frame, const Se3& map_from_base, bool on_floor) {
  // What one keyframe alone has seen may have walked away since.
  std::vector<int> lasting;
  for (const int l : landmarks) {
    if (map.landmark(l).sightings.size() >= 2) lasting.push_back(l);
  }
  const DepthAgreement view = depth_agreement(map, lasting, frame, map_from_base, on_floor);
  if (view.judged() + view.hidden < kTellingLandmarks) return ViewVerdict::kSilent;
  if (view.hidden > view.judged()) return ViewVerdict::kHidden;
  return view.share() < kAgreeingShare ? ViewVerdict::kContradicts : ViewVerdict::kAgrees;
}

}  // namespace rovigo::slam
