#include "slam/localizer.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>

#include "slam/camera_frame.h"
#include "slam/grid_match.h"
#include "slam/local_map.h"
#include "slam/map_storage.h"
#include "slam/motion_model.h"
#include "slam/place_finder.h"
#include "slam/relocalizer.h"
#include "slam/view_check.h"
#include "slam/view_continuity.h"

namespace rovigo::slam {

namespace {

constexpr double kFixSigmaM = 0.05;  // of a freshly recognised place, before frames confirm it
constexpr double kFixSigmaRad = 0.03;
constexpr double kPriorGates = 4.0;  // sigmas around a given pose that are searched
constexpr int kTriesSearching = 4;   // places a frame, by geometry
constexpr int kTriesConfirming = 2;
constexpr int kSpotCheckEvery = 15;       // frames: does the whole map agree with what is tracked?
constexpr double kLostAfterS = 0.3;       // of contradiction, after the view has jumped,
constexpr int kLostAfterMisses = 3;       // and so many frames
constexpr double kReconfirmAfterS = 0.5;  // blind for longer, the rover may be anywhere
constexpr double kFrameGaps = 2.5;        // usual intervals without a frame: the camera fell silent
constexpr int kMinTelling = 15, kSureTelling = 20;  // matches that tell one place from another
constexpr double kSureScanShare = 0.7, kSureDepthShare = 0.8;  // to become OK
constexpr double kPlausibleScanShare =
    0.75;                                // to be believed for a moment, with no view recognised
constexpr double kHeldScanShare = 0.75;  // of one view, to hold a pose by it alone
constexpr std::size_t kEnoughScan = 40;  // points of it
constexpr double kSamePlaceM = 0.7;      // no reason to go elsewhere
constexpr int kSureScanPoints = 60;
constexpr double kNoShapeMargin = 0.1;
constexpr double kLeastBelief = 0.5;  // in a place not yet confirmed, to call it more than LOST
constexpr double kWorseThanRival = -0.05;
constexpr double kMostRival = 0.2,
                 kMostRivalTracking = 0.35;  // share of the votes that another place may have
constexpr double kStillScanShare = 0.5;
// Of the confidence, while a frame does not fit: after a jump of the view, and while it goes on.
constexpr double kBrokenShare = 0.3, kUnbrokenShare = 0.95;
constexpr double kSureRecognition = 0.9;  // where views cannot be added up
constexpr double kFullWeightInliers = 40.0;
}  // namespace

struct Localizer::Impl {
  enum class State { kSearching, kConfirming, kTracking };

  /// `start`: how wheels and gyro are calibrated, as far as that is known.
  Impl(const SlamConfig& settings, const Rig& r, const LandmarkMap& known,
       const maps::OccupancyGrid& grid, DepthMemory depths, const MotionModel& start)
      : config(settings),
        rig(r),
        map(known),
        motion(start),
        odometry(start),
        continuity(map.camera(), map.base_from_camera()),
        finder(motion.planar() ? grid : maps::OccupancyGrid{}, std::move(depths)),
        relocalizer(map),
        checker(map, finder.has_grid() ? &finder.field() : nullptr,
                relocalizer.repeated_landmarks(map), motion.planar()) {}

  void expect_near(const PosePrior& given);
  void begin(double time_s);
  void on_frame(const mrpt::obs::CObservation3DRangeScan& scan);
  void on_frame(const CameraFrame& frame, FeatureSet features);
  void note_interval(double time_s);
  void look_everywhere(const SeenView& view);
  void judge_places(const SeenView& view, bool is_new);
  void adopt(double time_s, const Se3& map_from_base);
  bool hold_by_scan(const SeenView& view, const std::vector<int>& local_landmarks);
  void follow(const SeenView& view);
  void take_in(const SeenView& view, const TrackResult& result, const ViewCheck& seen);
  void note_agreement(double time_s, int inliers, const ViewCheck& seen);
  void miss(const SeenView& view, const std::vector<int>& local_landmarks,
            const MotionPrediction& prediction);
  void weigh_support(double time_s);
  Se3 odom_from_base(double time_s) { return odometry.predict(time_s).prior.map_from_base; }
  Se3 believed(double time_s) { return motion.predict(time_s).prior.map_from_base; }
  bool is_convincing() const;
  void lose();
  bool camera_is_silent(double time_s) const;
  PoseEstimate estimate(double time_s);

  SlamConfig config;
  Rig rig;
  const LandmarkMap& map;
  MotionModel motion;
  MotionModel odometry;  ///< never corrected: ties together what is seen while searching
  ViewContinuity continuity;
  PlaceFinder finder;
  Relocalizer relocalizer;
  ViewChecker checker;
  std::optional<PoseRegion> prior;
  double prior_sigma_m = 0.0, prior_sigma_rad = 0.0;

  State state = State::kSearching;
  bool begun = false;
  bool has_pose = false;  ///< some pose to carry on from, right or not
  std::vector<int> tracked;
  LocalizerEvidence evidence;
  int frames = 0;
  int misses = 0;         ///< frames in a row that matched nothing
  bool broken = false;    ///< the view has jumped since a frame last agreed
  bool was_sure = false;  ///< of this place, before the camera was blind
  bool doubt = false;     ///< the newest frame shows plenty and does not fit
  std::optional<double> contradicted_since_s;
  double last_fix_s = -1e9;
  double last_frame_s = -1e9;
  double frame_interval_s = 0.1;  ///< usual one
};

void Localizer::Impl::expect_near(const PosePrior& given) {
  prior = PoseRegion{from_planar(given.map_from_base), kPriorGates * given.sigma_position_m,
                     kPriorGates * given.sigma_heading_rad};
  prior_sigma_m = given.sigma_position_m;
  prior_sigma_rad = given.sigma_heading_rad;
}

void Localizer::Impl::begin(double time_s) {
  if (begun) return;
  begun = true;
  odometry.place(time_s, Se3{}, 0.0, 0.0);
  if (!prior) return;
  motion.place(time_s, prior->map_from_base, prior_sigma_m, prior_sigma_rad);
  has_pose = true;
}

void Localizer::Impl::lose() {
  state = State::kSearching;
  was_sure = false;
  evidence = {};
  misses = 0;
  doubt = false;
  contradicted_since_s.reset();
  tracked.clear();
  finder.clear();
}

void Localizer::Impl::note_interval(double time_s) {
  const double interval = time_s - last_frame_s;
  if (interval > 0.0 && interval < 1.0) frame_interval_s += 0.2 * (interval - frame_interval_s);
  last_frame_s = time_s;
}

bool Localizer::Impl::camera_is_silent(double time_s) const {
  return time_s - last_frame_s > kFrameGaps * frame_interval_s;
}

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
    if (checker.check(view, landmarks, solution.map_from_base, solution.inliers).contradicts)
      continue;
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
  if (there) return;
  // Odometry says it cannot be elsewhere; only a jump of the view would explain it.
  if (!was_sure) {
    adopt(time_s, place);
  } else if (broken) {
    lose();
  }
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
  const GridMatch match = match_scan(finder.field(), view.scan, to_planar(pose),
                                     motion.dead_reckoning().pose_covariance());
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
  evidence.inliers = inliers;
  evidence.depth_share = seen.depth_share;
  evidence.matched_share = seen.matched_share;
  last_fix_s = time_s;
  misses = 0;
  broken = doubt = false;
  contradicted_since_s.reset();
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
  const bool contradicted =
      (broken || !was_sure) && doubt &&
      (checker.map_knows_view(pose) ||
       checker.check(view, local_landmarks, pose, SeenView::kPlenty).contradicts);
  if (contradicted && !contradicted_since_s) contradicted_since_s = time_s;
  const bool carried_off = contradicted_since_s && misses >= kLostAfterMisses &&
                           time_s - *contradicted_since_s >= kLostAfterS;
  if (carried_off || motion.carried() ||
      prediction.sigma_position_m > config.localizer.lost_sigma_m) {
    lose();
  }
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
  return evidence.scan_points >= kSureScanPoints && evidence.scan_share >= kSureScanShare &&
         evidence.rival_share <= kMostRival && confidence_of(evidence) >= kOkConfidence;
}

void Localizer::Impl::on_frame(const mrpt::obs::CObservation3DRangeScan& scan) {
  const CameraFrame frame = camera_frame_from(scan, map.camera());
  FeatureSet features;
  if (!frame.gray.empty()) {
    features = extract_features(
        frame, map.camera(), config.features, config.depth,
        rolling_shutter_of(rig, config.tracking, motion.predict(frame.time_s).turn_rate_rad_s,
                           map.base_from_camera()));
  }
  on_frame(frame, std::move(features));
}

void Localizer::Impl::on_frame(const CameraFrame& frame, FeatureSet features) {
  ++frames;
  note_interval(frame.time_s);
  if (frame.gray.empty()) return;
  SeenView view{frame, std::move(features), {}};
  if (finder.has_grid() && !frame.depth.empty()) {
    view.scan = obstacle_points(frame.depth, frame.depth_unit_m, map.camera(),
                                map.base_from_camera(), config);
  }
  finder.fade();
  if (!motion.planar()) finder.forget_candidates();  // nothing ties one view to the next
  const bool is_new = finder.see(view.frame.time_s, odom_from_base(view.frame.time_s), view.scan,
                                 view.frame.depth, view.frame.depth_unit_m);
  const bool goes_on = continuity.follows(view.frame, odom_from_base(view.frame.time_s));
  broken |= !goes_on || !motion.planar();
  const bool believed_before = state != State::kSearching;
  if (believed_before) follow(view);
  const bool just_lost = believed_before && state == State::kSearching;  // says so for a frame
  const bool spot_check = frames % kSpotCheckEvery == 0;
  if (!just_lost && (state != State::kTracking || misses > 0 || spot_check)) {
    look_everywhere(view);
    judge_places(view, is_new);
    weigh_support(view.frame.time_s);
  }
  const MotionPrediction now = motion.predict(view.frame.time_s);
  evidence.sigma_position_m = now.sigma_position_m;
  evidence.sigma_heading_rad = now.sigma_heading_rad;
  if (state == State::kConfirming && is_convincing()) {
    state = State::kTracking;
    was_sure = true;
    prior.reset();  // it has done its work; from here on the map decides
  }
}

PoseEstimate Localizer::Impl::estimate(double time_s) {
  PoseEstimate e;
  e.time_s = time_s;
  if (!has_pose) return e;
  const MotionPrediction now = motion.predict(time_s);
  e.map_from_base = to_mrpt(now.prior.map_from_base);
  e.sigma_position_m = now.sigma_position_m;
  e.sigma_heading_rad = now.sigma_heading_rad;
  if (state == State::kSearching) return e;
  evidence.sigma_position_m = now.sigma_position_m;
  evidence.sigma_heading_rad = now.sigma_heading_rad;
  evidence.unseen_s = time_s - last_fix_s;
  e.confidence = (!doubt ? 1.0 : broken ? kBrokenShare : kUnbrokenShare) * confidence_of(evidence);
  const bool fresh =
      !doubt && !camera_is_silent(time_s) && evidence.unseen_s <= config.localizer.degraded_after_s;
  const bool sure = state == State::kTracking && evidence.rival_share <= kMostRivalTracking &&
                    e.confidence >= kOkConfidence;
  // A place that has yet to convince is a guess; somebody's word that it is there is more.
  const bool guess = !was_sure && !prior && e.confidence < kLeastBelief;
  e.health = sure && fresh ? Health::kOk : guess ? Health::kLost : Health::kDegraded;
  return e;
}

Localizer::Localizer(const SlamConfig& config, const Rig& rig, const maps::SavedMap& map,
                     const std::optional<PosePrior>& prior)
    : restored_(std::make_unique<LandmarkMap>(restore_landmark_map(map, config))) {
  DepthMemory depths(restored_->camera(), restored_->base_from_camera());
  for (const auto& k : map.keyframes) depths.add(from_mrpt(k.map_from_base), k.depth_png);
  impl_ = std::make_unique<Impl>(config, rig, *restored_, map.grid, std::move(depths),
                                 MotionModel(config, rig));
  if (prior) impl_->expect_near(*prior);
}

Localizer::Localizer(const SlamConfig& config, const Rig& rig, const LandmarkMap& map,
                     const maps::OccupancyGrid& grid, const MotionModel& motion) {
  DepthMemory depths(map.camera(), map.base_from_camera());
  for (const Keyframe& k : map.keyframes()) {
    if (!k.culled()) depths.add(k.map_from_base, k.depth_png);
  }
  impl_ = std::make_unique<Impl>(config, rig, map, grid, std::move(depths), motion);
}

Localizer::~Localizer() = default;

PoseEstimate Localizer::process(const CameraFrame& frame, FeatureSet features) {
  impl_->begin(frame.time_s);
  impl_->on_frame(frame, std::move(features));
  return impl_->estimate(frame.time_s);
}

PoseEstimate Localizer::process(const mrpt::obs::CObservation& observation) {
  Impl& l = *impl_;
  const double time_s = time_of(observation);
  l.begin(time_s);
  if (const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation)) {
    l.on_frame(*scan);
  } else if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation)) {
    l.motion.add(*imu);
    l.odometry.add(*imu);
  } else if (const auto* wheels =
                 dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
    l.motion.add(*wheels);
    l.odometry.add(*wheels);
  }
  return l.estimate(time_s);
}

std::optional<LocalizerEvidence> Localizer::evidence() const {
  if (impl_->state == Impl::State::kSearching) return std::nullopt;
  return impl_->evidence;
}

}  // namespace rovigo::slam
