#include "slam/recovery.h"

#include "slam/keyframe_uncertainty.h"
#include "slam/place_match.h"

namespace rovigo::slam {

namespace {

constexpr int kSearchEverywhereEvery = 5;  // frames without a match
constexpr int kSearchWhenLostEvery = 2;
constexpr double kSurprisingM = 0.15;
constexpr double kWorthlessSigmaM = 0.5;  // dead reckoning beyond it holds nobody back from a jump

}  // namespace

Relocalization Recovery::recognise(const LocalMap& local, const FeatureSet& features,
                                   std::uint64_t seed) const {
  const bool on_floor = motion_.planar();
  Relocalization found;
  found.match = match_place(map_, local.landmarks, local.landmarks, features, on_floor,
                            {.min_inliers = 2 * config_.tracking.min_inliers, .seed = seed});
  found.keyframe = local.reference_keyframe;
  const bool lost = health_.state() == TrackingState::kLost;
  if (found.match.accepted || misses_ % (lost ? kSearchWhenLostEvery : kSearchEverywhereEvery)) {
    return found;
  }
  return relocalizer_.find(map_, features, on_floor, std::nullopt, {},
                           {.min_inliers = config_.localizer.relocalization_inliers, .seed = seed});
}

void Recovery::recover(double time_s, const LocalMap& local, const FeatureSet& features,
                       std::uint64_t seed, TrackResult& result) {
  ++misses_;
  const Relocalization found = recognise(local, features, seed);
  if (!found.match.accepted) return;
  const MotionPrediction believed = motion_.predict(time_s);
  const Se3& seen = found.match.solution.map_from_base;
  const double apart = (believed.prior.map_from_base.translation - seen.translation).norm();
  if (apart > kSurprisingM + 4.0 * believed.sigma_position_m) {
    // A look-alike, unless something has shown that the prediction is worth nothing.
    const bool trusted = motion_.planar() && health_.state() != TrackingState::kLost;
    if (trusted && believed.sigma_position_m < kWorthlessSigmaM) return;
    move_to(time_s, seen, believed.prior.map_from_base, found.keyframe);
  }
  result.status = TrackStatus::kTracked;
  result.solution = found.match.solution;
  result.matches = found.match.matches;
  misses_ = 0;
}

void Recovery::move_to(double time_s, const Se3& seen, const Se3& believed, int keyframe) {
  const bool doubted = health_.state() != TrackingState::kTracking;
  const double since_s = jump_ ? jump_->since_s : doubted ? health_.doubted_since_s() : time_s;
  jump_ = Jump{since_s, time_s, keyframe, seen * believed.inverse()};
  motion_.place(time_s, seen, kFoundSigmaM, kFoundSigmaRad);
  motion_.cut_link();
  health_.found_elsewhere();
}

void Recovery::sharpen(const Se3& seen_from_predicted) {
  if (jump_) jump_->new_map_from_old_map = seen_from_predicted * jump_->new_map_from_old_map;
}

void Recovery::mend(TrajectoryHistory& history) {
  if (!jump_ || health_.state() != TrackingState::kTracking) return;
  history.reanchor(jump_->since_s, jump_->until_s, map_, jump_->keyframe,
                   jump_->new_map_from_old_map);
  jump_.reset();
}

}  // namespace rovigo::slam
