// Looking for the place: what the whole map says about the view.

#include <algorithm>

#include "slam/localizer_impl.h"

namespace rovigo::slam {

namespace {

constexpr double kFixSigmaM = 0.05;  // of a freshly recognised place, before frames confirm it
constexpr double kFixSigmaRad = 0.03;
constexpr int kTriesSearching = 4;  // places a frame, by geometry
constexpr int kTriesConfirming = 2;
constexpr int kMinTelling = 15, kSureTelling = 20;  // matches that tell one place from another
constexpr double kSureScanShare = 0.7, kSureDepthShare = 0.8;  // to become OK
constexpr double kPlausibleScanShare = 0.75;  // to be believed for a moment, unrecognised
constexpr double kSamePlaceM = 0.7;           // no reason to go elsewhere
constexpr int kSureScanPoints = 60;
constexpr double kTellingMargin = 0.04;  // makes up for a scan that shows less
constexpr double kRefutedConfidence = 0.05;
constexpr double kNoShapeMargin = 0.1;
constexpr double kWorseThanRival = -0.05;
constexpr double kMostRival = 0.2;  // share of the votes that another place may have
constexpr double kStillScanShare = 0.5;
constexpr double kSureRecognition = 0.9;  // where views cannot be added up
constexpr double kFullWeightInliers = 40.0;

}  // namespace

/// Compares the view with the whole map; what geometry accepts speaks for a place.
void Localizer::Impl::look_everywhere(const SeenView& view) {
  const PlaceMatchConfig place{.min_inliers = config.localizer.relocalization_inliers,
                               .seed = static_cast<std::uint64_t>(frames)};
  const int tries = state == State::kSearching ? kTriesSearching : kTriesConfirming;
  const auto found =
      relocalizer.find_places(map, view.features, motion.planar(), prior, tries, place);
  for (const Relocalization& r : found) {
    const PoseSolution& solution = r.match.solution;
    const int clear = checker.telling(r.match.matches);
    if (clear < kMinTelling) continue;
    const auto landmarks = map.landmarks_of({r.keyframe});
    const ViewCheck seen = checker.check(view, landmarks, solution.map_from_base, solution.inliers);
    if (seen.contradicts) continue;
    finder.recognize(solution.map_from_base, odom_from_base(view.frame.time_s),
                     std::min(1.0, clear / kFullWeightInliers));
  }
}

/// Goes to the place that most speaks for, if it is not where the rover is believed to be.
void Localizer::Impl::judge_places(const SeenView& view, bool is_new) {
  const double time_s = view.frame.time_s;
  const Se3 odom = odom_from_base(time_s);
  if (is_new) {
    finder.search(odom, prior);
  } else {
    finder.judge(odom);
  }
  const auto best = finder.best();
  if (!best || (best->recognitions == 0.0 && best->scan_share < kPlausibleScanShare)) return;
  const Se3 place = best->map_from_odom * odom;
  const bool there = state != State::kSearching &&
                     (place.translation - believed(time_s).translation).norm() < kSamePlaceM;
  if (there || (matches_here() && best->recognitions <= evidence.recognitions)) return;
  // Odometry says it cannot be elsewhere: the view has jumped, or it was never there.
  if (!was_sure || confidence_of(evidence) < kRefutedConfidence) {
    adopt(time_s, place);
  } else if (broken) {
    lose();
  }
}

/// Views that match say more than a little more of shape elsewhere.
bool Localizer::Impl::matches_here() const {
  return state == State::kConfirming && misses == 0 && evidence.inliers >= kMinTelling;
}

void Localizer::Impl::adopt(double time_s, const Se3& map_from_base) {
  motion.place(time_s, map_from_base, kFixSigmaM, kFixSigmaRad);
  has_pose = true;
  state = State::kConfirming;
  was_sure = false;
  misses = 0;
  doubt = false;
  contradicted_since_s.reset();
  evidence = {};
  last_fix_s = time_s;
  tracked.clear();
}

/// What speaks for the place believed, and for others.
void Localizer::Impl::weigh_support(double time_s) {
  const PlaceSupport support = finder.support(believed(time_s), odom_from_base(time_s));
  evidence.recognitions = support.recognitions;
  evidence.rival_share = support.rival_recognition_share();
  evidence.scan_share = support.scan_share;
  evidence.surface_share = support.surface_share;
  // Without a floor there is no shape to compare; matches that fix all six degrees of freedom have
  // to speak for themselves.
  evidence.shape_margin = finder.has_grid() ? support.shape - support.rival_shape : kNoShapeMargin;
  evidence.scan_points = support.scan_points;
}

/// Enough frames agree, and the whole map has no better place for what they show.
bool Localizer::Impl::is_convincing() const {
  if (evidence.agreeing_frames < config.localizer.confirmation_frames) return false;
  // Blind for a moment only, or told where to look: that speaks for the place, too.
  if (was_sure || prior) {
    return evidence.scan_share >= kStillScanShare && evidence.rival_share <= kMostRival &&
           evidence.shape_margin >= kWorseThanRival;
  }
  if (!finder.has_grid()) {
    return evidence.depth_share >= kSureDepthShare && evidence.inliers >= kSureTelling &&
           evidence.recognitions >= kSureRecognition && evidence.rival_share <= kMostRival;
  }
  const bool enough_seen =
      evidence.scan_points >= kSureScanPoints || evidence.shape_margin >= kTellingMargin;
  return enough_seen && evidence.scan_share >= kSureScanShare &&
         evidence.rival_share <= kMostRival && confidence_of(evidence) >= kOkConfidence;
}

}  // namespace rovigo::slam
