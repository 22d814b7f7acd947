// Following a place from frame to frame: the view against the map around the pose believed.

#include <algorithm>

#include "slam/localizer_impl.h"

namespace rovigo::slam {

namespace {

constexpr double kLostAfterS = 0.3;       // of contradiction, after the view has jumped,
constexpr int kLostAfterMisses = 3;       // and so many frames
constexpr double kUnvouchedAfterS = 0.8;  // looking around after such a jump, and nothing fits
constexpr double kReconfirmAfterS = 0.5;  // blind for longer, the rover may be anywhere
constexpr double kHeldScanShare = 0.75;   // of one view, to hold a pose by it alone
constexpr std::size_t kEnoughScan = 40;   // points of it,
constexpr int kEnoughOnMap = 20;          // and of them on ground the map knows
constexpr double kNewShare = 0.1;         // of the local scan, from one frame to the next
constexpr double kKeptInliers = 0.98;     // a frame, rounded down; half is left after a second

}  // namespace

void Localizer::Impl::follow(const SeenView& view) {
  const MotionPrediction prediction = motion.predict(view.frame.time_s);
  const LocalMap local = select_local_map(map, tracked, prediction.prior.map_from_base);
  const TrackResult result = track_frame(map, local.landmarks, view.features, prediction);
  if (result.status == TrackStatus::kTracked) {
    const PoseSolution& solution = result.solution;
    const ViewCheck seen =
        checker.check(view, local.landmarks, solution.map_from_base, solution.inliers);
    if (!seen.contradicts) {
      take_in(view, result, seen);
      return;
    }
  }
  if (!hold_by_scan(view, local.landmarks)) miss(view, local.landmarks, prediction);
}

/// Where the map knows no features, or not from this side, its walls still hold the pose.
bool Localizer::Impl::hold_by_scan(const SeenView& view, const std::vector<int>& local_landmarks) {
  if (broken || !finder.has_grid() || view.scan.size() < kEnoughScan) return false;
  const double time_s = view.frame.time_s;
  const Se3 pose = believed(time_s);
  if (view.shows_plenty() && checker.map_knows_view(pose)) return false;
  const auto known = [&](const ScanPoint& p) {
    return finder.field().cell_at(maps::transform(to_planar(pose), p.base_point)).known;
  };
  // On ground nobody has seen there is nothing to hold on to.
  if (std::count_if(view.scan.begin(), view.scan.end(), known) < kEnoughOnMap) return false;
  // One wall leaves much open; what was seen a moment ago, around a corner, does not.
  GridMatch match = match_scan(finder.field(), finder.local_scan(), to_planar(pose),
                               motion.dead_reckoning().pose_covariance());
  match.look.information *= kNewShare;
  match.look.gradient *= kNewShare;
  const Se3 held = from_planar(match.look.map_from_base);
  const ViewCheck seen = checker.check(view, local_landmarks, held, SeenView::kPlenty);
  if (seen.contradicts || seen.scan_share < kHeldScanShare) return false;
  motion.correct(match.look);
  tracked.clear();
  note_agreement(time_s, 0, seen);
  return true;
}

void Localizer::Impl::take_in(const SeenView& view, const TrackResult& result,
                              const ViewCheck& seen) {
  motion.correct(view.frame.time_s, result.solution);
  tracked.clear();
  for (const FeatureMatch& m : result.matches) tracked.push_back(m.landmark);
  note_agreement(view.frame.time_s, checker.telling(result.matches), seen);
}

void Localizer::Impl::note_agreement(double time_s, int inliers, const ViewCheck& seen) {
  if (time_s - last_fix_s > kReconfirmAfterS && state == State::kTracking) {
    state = State::kConfirming;
    evidence.agreeing_frames = 0;
  }
  ++evidence.agreeing_frames;
  inliers_now = inliers;
  // In a view that goes on, what matched a moment ago still speaks for the place.
  const int kept = broken ? 0 : static_cast<int>(kKeptInliers * evidence.inliers);
  evidence.inliers = std::max(inliers, kept);
  evidence.depth_share = seen.depth_share;
  evidence.matched_share = seen.matched_share;
  last_fix_s = time_s;
  misses = 0;
  broken = doubt = false;
  contradicted_since_s.reset();
  unvouched_since_s.reset();
}

void Localizer::Impl::miss(const SeenView& view, const std::vector<int>& local_landmarks,
                           const MotionPrediction& prediction) {
  const double time_s = view.frame.time_s;
  const Se3& pose = prediction.prior.map_from_base;
  motion.miss(time_s);
  tracked.clear();
  ++misses;
  doubt = view.shows_plenty();
  // In an unbroken view nobody has carried the rover: the map is old, or never saw this side.
  // Few features are no match, and no contradiction either; walls where there should be none are.
  const bool contradicted =
      (broken || !was_sure) &&
      ((doubt && checker.map_knows_view(pose)) ||
       checker.check(view, local_landmarks, pose, SeenView::kPlenty).contradicts);
  if (contradicted && !contradicted_since_s) contradicted_since_s = time_s;
  const bool carried_off = contradicted_since_s && misses >= kLostAfterMisses &&
                           time_s - *contradicted_since_s >= kLostAfterS;
  // Where the map knows nothing of the view, nothing contradicts it, and nothing vouches for it.
  if (!(broken && doubt && motion.planar())) {
    unvouched_since_s.reset();
  } else if (!unvouched_since_s) {
    unvouched_since_s = time_s;
  }
  const bool unvouched = was_sure && unvouched_since_s && misses >= kLostAfterMisses &&
                         time_s - *unvouched_since_s >= kUnvouchedAfterS;
  if (unvouched || motion.carried() ||
      prediction.sigma_position_m > config.localizer.lost_sigma_m) {
    lose(time_s);
  } else if (carried_off) {
    was_sure ? lose(time_s) : drop_guess(time_s);
  }
}

}  // namespace rovigo::slam
