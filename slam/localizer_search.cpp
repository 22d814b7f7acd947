// Looking for the place: what the whole map says about the view.

#include <algorithm>
#include <cmath>

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
constexpr int kSureFramesByWalls = 30;
constexpr double kTellingMargin = 0.04;  // makes up for a scan that shows less
constexpr double kBetterHeld = 0.03;     // of the local scan: walls in one view alone have misled
constexpr double kReachSigmas = 3.0;
constexpr double kRefutedConfidence = 0.05;
constexpr double kNoShapeMargin = 0.1;
constexpr double kWorseThanRival = -0.05;
constexpr double kMuchWorse = -0.06;  // look-alikes match for seconds
constexpr double kMostRival = 0.2;    // share of the votes that another place may have
constexpr double kStillScanShare = 0.5;
constexpr double kSureRecognition = 0.9;                           // where views cannot be added up
constexpr double kSureRecognitions = 4.0, kHardlyRivalled = 0.02;  // make up for few scan points
constexpr double kFullWeightInliers = 40.0;
// Of places beside one another, by the features that fit: a sixth fewer leaves a quarter.
constexpr double kLikenessPower = 8.0, kLeastLikeness = 0.05;
constexpr double kStepCost = 0.03;  // of the shape: along a wall it hardly changes
constexpr double kSurelyBetter = 1.15, kNearlyAsGood = 0.85;  // one brick aside
constexpr int kSureStep = 25;                                 // features; by chance a dozen meet

double likeness(int features, int best) {
  return std::pow(static_cast<double>(features) / best, kLikenessPower);
}

Se3 shifted(Se3 map_from_base, const Eigen::Vector2d& shift_map) {
  map_from_base.translation.head<2>() += shift_map;
  return map_from_base;
}

}  // namespace

/// Compares the view with the whole map; what geometry accepts speaks for a place. True if anything
/// did.
bool Localizer::Impl::look_everywhere(const SeenView& view) {
  bool recognized = false;
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
    recognize(view, solution.map_from_base, std::min(1.0, clear / kFullWeightInliers));
    recognized = true;
  }
  return recognized;
}

/// Walls repeat themselves: what fits the view about as well beside the place shares in it.
void Localizer::Impl::recognize(const SeenView& view, const Se3& map_from_base, double weight) {
  const Se3 odom = odom_from_base(view.frame.time_s);
  SlideSpectrum spectrum;  // without a floor, places beside are not at the same height either
  if (motion.planar()) spectrum = slide.around(view.features, map_from_base);
  if (spectrum.best() < kMinTelling) {
    finder.recognize(map_from_base, odom, weight);
    return;
  }
  const double here = likeness(spectrum.here, spectrum.best());
  if (here >= kLeastLikeness) finder.recognize(map_from_base, odom, weight * here);
  for (const Slide& s : spectrum.elsewhere) {
    const double there = likeness(s.features, spectrum.best());
    if (there < kLeastLikeness) continue;
    finder.recognize(shifted(map_from_base, s.shift_map), odom, weight * there);
  }
}

/// Is the view better explained a brick or a panel further? A step aside is taken at once; what is
/// farther off becomes a rival that shape has to refute. A view that matches many landmarks that
/// look like no other speaks for the place as one recognised does.
void Localizer::Impl::look_beside(const SeenView& view, bool recognized) {
  const double time_s = view.frame.time_s;
  const Se3 here = believed(time_s);
  const SlideSpectrum spectrum = slide.around(view.features, here);
  for (const Slide& s : spectrum.elsewhere) {
    if (s.shift_map.norm() >= kSamePlaceM) continue;
    if (s.features > kSurelyBetter * spectrum.here && s.features >= kSureStep &&
        fits_as_well(time_s, here, s)) {
      step_aside(time_s, shifted(here, s.shift_map));
      return;
    }
    if (s.features >= kMinTelling && s.features > kNearlyAsGood * spectrum.here) {
      evidence.agreeing_frames = 0;  // it could be either
    }
  }
  if (!recognized && misses == 0 && inliers_now >= kSureTelling) {
    recognize(view, here, std::min(1.0, inliers_now / kFullWeightInliers));
  }
}

/// Features alone may meet by chance; what stands around has to fit there, too.
bool Localizer::Impl::fits_as_well(double time_s, const Se3& here, const Slide& aside) {
  const Se3 odom = odom_from_base(time_s);
  return finder.support(shifted(here, aside.shift_map), odom).shape >=
         finder.support(here, odom).shape - kStepCost;
}

/// At a place freshly found; what was seen on the way to the old one says nothing of it.
void Localizer::Impl::put(double time_s, const Se3& map_from_base) {
  motion.place(time_s, map_from_base, kFixSigmaM, kFixSigmaRad);
  trail.clear();
}

/// The same room, but matched one brick too far.
void Localizer::Impl::step_aside(double time_s, const Se3& map_from_base) {
  put(time_s, map_from_base);
  state = State::kConfirming;
  evidence.agreeing_frames = 0;
  tracked.clear();
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
  if (vouched) {
    // What was said of the start is worth more than walls that fit a little better elsewhere.
    if (best->recognitions > 0.0 && misses > 0) {
      adopt(time_s, place);
      vouched = true;
    }
    return;
  }
  if (there && evidence.inliers == 0 && best->scan_share > evidence.scan_share + kBetterHeld &&
      within_reach(time_s, place)) {
    put(time_s, place);
  }
  if (there || (matches_here() && best->recognitions <= evidence.recognitions)) return;
  // Odometry says it cannot be elsewhere: the view has jumped, or it was never there.
  if (!was_sure || confidence_of(evidence) < kRefutedConfidence) {
    adopt(time_s, place);
  } else if (broken) {
    lose(time_s);
  }
}

/// Whether the rover can be there, by what wheels and gyro say. A place being confirmed may be as
/// far off as all that was matched so far.
bool Localizer::Impl::within_reach(double time_s, const Se3& map_from_base) {
  if (!was_sure) return true;
  const double away_m = (map_from_base.translation - believed(time_s).translation).norm();
  return away_m <= kReachSigmas * motion.predict(time_s).sigma_position_m;
}

/// Views that match say more than a little more of shape elsewhere; than much more they do not.
bool Localizer::Impl::matches_here() const {
  return state == State::kConfirming && misses == 0 && inliers_now >= kMinTelling &&
         evidence.shape_margin > kMuchWorse;
}

void Localizer::Impl::adopt(double time_s, const Se3& map_from_base) {
  put(time_s, map_from_base);
  has_pose = true;
  state = State::kConfirming;
  was_sure = vouched = false;
  misses = 0;
  broken = false;  // before this: the place is judged by what was seen since
  doubt = false;
  contradicted_since_s.reset();
  unvouched_since_s.reset();
  evidence = {};
  inliers_now = 0;
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

/// Walls alone leave a pose open along them until the rover has seen around a corner or two; some
/// matches that tell places apart shorten the wait.
double Localizer::Impl::frames_to_be_sure() const {
  const double lacking = 1.0 - static_cast<double>(evidence.inliers) / kMinTelling;
  return kSureFramesByWalls * std::max(0.0, lacking);
}

/// Enough frames agree, and the whole map has no better place for what they show.
bool Localizer::Impl::is_convincing() const {
  if (evidence.agreeing_frames < config.localizer.confirmation_frames) return false;
  // Blind for a moment only, or told where to look: that speaks for the place, too.
  if (was_sure || vouched) {
    return evidence.scan_share >= kStillScanShare && evidence.rival_share <= kMostRival &&
           evidence.shape_margin >= kWorseThanRival;
  }
  if (!finder.has_grid()) {
    return evidence.depth_share >= kSureDepthShare && evidence.inliers >= kSureTelling &&
           evidence.recognitions >= kSureRecognition && evidence.rival_share <= kMostRival;
  }
  if (evidence.agreeing_frames < frames_to_be_sure()) return false;
  const bool clearly_recognized =
      evidence.recognitions >= kSureRecognitions && evidence.rival_share <= kHardlyRivalled;
  const bool enough_seen = evidence.scan_points >= kSureScanPoints ||
                           evidence.shape_margin >= kTellingMargin || clearly_recognized;
  return enough_seen && evidence.scan_share >= kSureScanShare &&
         evidence.rival_share <= kMostRival && confidence_of(evidence) >= kOkConfidence;
}

}  // namespace rovigo::slam
