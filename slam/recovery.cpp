#include "slam/recovery.h"

#include "slam/keyframe_uncertainty.h"
#include "slam/place_match.h"

namespace rovigo::slam {

namespace {

constexpr int kSearchEverywhereEvery = 5;  // frames without a match
constexpr int kSearchWhenLostEvery = 2;
constexpr double kSurprisingM = 0.15;
constexpr double kWorthlessSigmaM = 0.5;  // dead reckoning beyond it is no better than none

}  // namespace

void Recovery::add(const mrpt::obs::CObservation& reading) {
  if (search_) guess_ = search_->process(reading);
}

void Recovery::recover(const CameraFrame& frame, const FeatureSet& features, std::uint64_t seed,
                       LocalMap& local, TrackResult& result) {
  ++misses_;
  if (must_search()) {
    search(frame, features, local, result);
  } else {
    recognise(frame.time_s, features, seed, local, result);
  }
}

void Recovery::search(const CameraFrame& frame, const FeatureSet& features, LocalMap& local,
                      TrackResult& result) {
  if (!search_) search_.emplace(config_, rig_, map_, surroundings_.grid_so_far(map_), motion_);
  const PoseEstimate found = search_->process(frame, features);
  guess_ = found;
  if (found.health != Health::kOk) return;
  const Se3 believed = motion_.predict(frame.time_s).prior.map_from_base;
  const Se3 seen = from_mrpt(found.map_from_base);
  local = select_local_map(map_, {}, seen);
  move_to(frame.time_s, seen, believed, local.reference_keyframe);
  health_.found_for_sure();
  result = track_frame(map_, local.landmarks, features, motion_.predict(frame.time_s));
  misses_ = 0;
}

void Recovery::recognise(double time_s, const FeatureSet& features, std::uint64_t seed,
                         const LocalMap& local, TrackResult& result) {
  const Relocalization found = recognise_anywhere(local, features, seed);
  if (!found.match.accepted) return;
  const MotionPrediction believed = motion_.predict(time_s);
  const Se3& seen = found.match.solution.map_from_base;
  const double apart = (believed.prior.map_from_base.translation - seen.translation).norm();
  if (apart > kSurprisingM + 4.0 * believed.sigma_position_m) {
    if (motion_.planar()) {
      // A look-alike, unless the prediction is worth nothing: then the whole map is asked.
      if (believed.sigma_position_m > kWorthlessSigmaM) health_.give_up();
      return;
    }
    move_to(time_s, seen, believed.prior.map_from_base, found.keyframe);
    health_.found_elsewhere();
  }
  result.status = TrackStatus::kTracked;
  result.solution = found.match.solution;
  result.matches = found.match.matches;
  misses_ = 0;
}

Relocalization Recovery::recognise_anywhere(const LocalMap& local, const FeatureSet& features,
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

void Recovery::move_to(double time_s, const Se3& seen, const Se3& believed, int keyframe) {
  const bool doubted = health_.state() != TrackingState::kTracking;
  const double since_s = !jumps_.empty() ? jumps_.back().until_s
                         : doubted       ? health_.doubted_since_s()
                                         : time_s;
  sharpen(seen * believed.inverse());
  jumps_.push_back({since_s, time_s, seen * believed.inverse()});
  place_ = keyframe;
  motion_.place(time_s, seen, kFoundSigmaM, kFoundSigmaRad);
  motion_.cut_link();
}

void Recovery::sharpen(const Se3& seen_from_predicted) {
  for (Jump& j : jumps_) j.new_map_from_old_map = seen_from_predicted * j.new_map_from_old_map;
}

void Recovery::mend(TrajectoryHistory& history) {
  if (health_.state() != TrackingState::kTracking) return;
  search_.reset();  // the map is about to change
  guess_.reset();
  for (const Jump& j : jumps_) {
    history.reanchor(j.since_s, j.until_s, map_, place_, j.new_map_from_old_map);
  }
  jumps_.clear();
}

}  // namespace rovigo::slam
