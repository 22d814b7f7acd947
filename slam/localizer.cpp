#include "slam/localizer.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>

#include "slam/camera_frame.h"
#include "slam/grid_match.h"
#include "slam/local_map.h"
#include "slam/localizer_depth_check.h"
#include "slam/localizer_votes.h"
#include "slam/map_storage.h"
#include "slam/motion_model.h"
#include "slam/relocalizer.h"

namespace rovigo::slam {

namespace {

constexpr double kFixSigmaM = 0.05;  // of a freshly recognised place, before frames confirm it
constexpr double kFixSigmaRad = 0.03;
constexpr double kPriorGates = 4.0;  // sigmas around a given pose that are searched
constexpr int kPlenty = 150;         // features; fewer and the camera may be covered or dark
constexpr int kTriesSearching = 4;   // places a frame, by geometry
constexpr int kTriesConfirming = 2;
constexpr int kSpotCheckEvery = 15;       // frames: does the whole map agree with what is tracked?
constexpr int kForgetFixAfter = 3;        // unconfirmed frames
constexpr double kLostAfterS = 0.6;       // of contradiction
constexpr double kReconfirmAfterS = 0.5;  // blind for longer, the rover may be anywhere
constexpr double kFrameGaps = 2.5;        // usual intervals without a frame: the camera fell silent
constexpr int kMinTelling = 15, kSureTelling = 20;  // matches that tell one place from another
constexpr double kSureScanShare = 0.5, kSureDepthShare = 0.8, kSureMatched = 0.2;  // to become OK
constexpr double kMostRival = 0.2,
                 kMostRivalTracking = 0.35;  // share of the votes that another place may have
constexpr double kStillScanShare = 0.5, kStillMatched = 0.15;
// Odometry says it cannot be elsewhere; only somebody who carried it can have brought it there.
constexpr int kFramesAfterLoss = 22;
constexpr double kDoubtfulShare = 0.3;  // of the confidence that is left while a frame contradicts
constexpr double kSureRecognitions = 1.2;  // of the whole map: two clear views or more
constexpr double kSureRecognition = 0.9;   // where views cannot be added up
constexpr double kFullWeightInliers = 40.0;
// A view this near a mapped one has to match it; elsewhere the map knows nothing to contradict.
constexpr double kSameViewM = 0.7;
constexpr double kSameViewRad = 0.45;
// What contradicts a pose: this much to judge by, and this little of it as the map has it.
constexpr int kEnoughLandmarks = 20, kEnoughPoints = 40, kEnoughAtDepth = 60;
constexpr double kLeastDepthShare = 0.6, kLeastScanShare = 0.5, kLeastMatchedShare = 0.08;

}  // namespace

struct Localizer::Impl {
  enum class State { kSearching, kConfirming, kTracking };

  struct View {
    CameraFrame frame;
    FeatureSet features;
    std::vector<ScanPoint> scan;  ///< empty where the camera's height is not known
    bool shows_plenty() const { return static_cast<int>(features.size()) >= kPlenty; }
  };

  Impl(const SlamConfig& settings, const Rig& r, const maps::SavedMap& saved,
       const std::optional<PosePrior>& given)
      : config(settings),
        map(restore_landmark_map(saved, settings)),
        motion(settings, r),
        odometry(settings, r) {
    if (motion.planar() && !saved.grid.cells.empty()) field.emplace(saved.grid);
    for (const Keyframe& k : map.keyframes()) relocalizer.add(map, k.id);
    repeated = relocalizer.repeated_landmarks(map);
    if (given) {
      prior = PoseRegion{from_planar(given->map_from_base), kPriorGates * given->sigma_position_m,
                         kPriorGates * given->sigma_heading_rad};
      prior_sigma_m = given->sigma_position_m;
      prior_sigma_rad = given->sigma_heading_rad;
    }
  }

  void begin(double time_s);
  void on_frame(const mrpt::obs::CObservation3DRangeScan& scan);
  void note_interval(double time_s);
  void look_everywhere(const View& view);
  void search(const View& view);
  void give_way();
  void adopt(double time_s, const Relocalization& found);
  void follow(const View& view);
  void take_in(const View& view, const TrackResult& result);
  void miss(const View& view, const std::vector<int>& local_landmarks,
            const MotionPrediction& prediction);
  bool contradicts(const View& view, const std::vector<int>& landmarks, const Se3& pose,
                   int inliers);
  int telling(const std::vector<FeatureMatch>& matches) const;
  void count_votes();
  bool is_convincing() const;
  void lose();
  bool map_knows_view(const Se3& map_from_base) const;
  bool camera_is_silent(double time_s) const;
  PoseEstimate estimate(double time_s);

  SlamConfig config;
  LandmarkMap map;
  MotionModel motion;
  MotionModel odometry;  ///< never corrected: ties together what is seen while searching
  Relocalizer relocalizer;
  std::vector<bool> repeated;  ///< by landmark: shows no particular place
  std::optional<SignedDistanceField> field;
  std::optional<PoseRegion> prior;
  double prior_sigma_m = 0.0, prior_sigma_rad = 0.0;

  State state = State::kSearching;
  bool begun = false;
  bool has_pose = false;  ///< some pose to carry on from, right or not
  std::vector<int> tracked;
  std::vector<Relocalization> found;  ///< in the newest frame that was compared with the whole map
  PlaceVotes votes;
  LocalizerEvidence evidence;
  int frames = 0;
  int misses = 0;           ///< frames in a row that matched nothing
  bool moved_away = false;  ///< a place was sure and then lost: the next one is an odd one
  bool was_sure = false;    ///< of this place, before the camera was blind
  bool doubt = false;       ///< the newest frame shows plenty and does not fit
  std::optional<double> contradicted_since_s;
  double last_fix_s = -1e9;
  double last_frame_s = -1e9;
  double frame_interval_s = 0.1;  ///< usual one
};

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
  if (was_sure) moved_away = true;
  was_sure = false;
  evidence = {};
  misses = 0;
  doubt = false;
  contradicted_since_s.reset();
  tracked.clear();
  votes.clear();
}

/// Whether somebody looked this way from here when the map was made.
bool Localizer::Impl::map_knows_view(const Se3& map_from_base) const {
  const TPose2D here = to_planar(map_from_base);
  return std::any_of(map.keyframes().begin(), map.keyframes().end(), [&](const Keyframe& k) {
    const TPose2D there = to_planar(k.map_from_base);
    return maps::distance(maps::position_of(here), maps::position_of(there)) < kSameViewM &&
           std::abs(maps::wrap_angle(here.phi - there.phi)) < kSameViewRad;
  });
}

void Localizer::Impl::note_interval(double time_s) {
  const double interval = time_s - last_frame_s;
  if (interval > 0.0 && interval < 1.0) frame_interval_s += 0.2 * (interval - frame_interval_s);
  last_frame_s = time_s;
}

bool Localizer::Impl::camera_is_silent(double time_s) const {
  return time_s - last_frame_s > kFrameGaps * frame_interval_s;
}

/// Compares the view with the whole map; what geometry accepts votes for where the rover is.
void Localizer::Impl::look_everywhere(const View& view) {
  const PlaceMatchConfig place{.min_inliers = config.localizer.relocalization_inliers,
                               .seed = static_cast<std::uint64_t>(frames)};
  const int tries = state == State::kSearching ? kTriesSearching : kTriesConfirming;
  found = relocalizer.find_places(map, view.features, motion.planar(), prior, tries, place);
  const Se3 odom_from_base = odometry.predict(view.frame.time_s).prior.map_from_base;
  std::erase_if(found, [&](const Relocalization& r) {
    const Se3& pose = r.match.solution.map_from_base;
    return telling(r.match.matches) < kMinTelling ||
           contradicts(view, map.landmarks_of({r.keyframe}), pose, r.match.solution.inliers);
  });
  for (const Relocalization& r : found) {
    const double weight = std::min(1.0, telling(r.match.matches) / kFullWeightInliers);
    votes.add(view.frame.time_s, r.match.solution.map_from_base, odom_from_base, weight);
  }
}

void Localizer::Impl::count_votes() {
  const Se3 odom_from_base = odometry.predict(last_frame_s).prior.map_from_base;
  const auto split = votes.split(motion.predict(last_frame_s).prior.map_from_base, odom_from_base);
  evidence.recognitions = split.here;
  const double all = split.here + split.elsewhere;
  evidence.rival_share = all > 0.0 ? split.elsewhere / all : 0.0;
}

/// Takes the place with the most votes for the rover's, if this very view voted for it.
void Localizer::Impl::search(const View& view) {
  look_everywhere(view);
  const auto best = votes.best();
  if (!best || found.empty()) return;
  const Se3 believed =
      best->map_from_odom * odometry.predict(view.frame.time_s).prior.map_from_base;
  for (const Relocalization& r : found) {
    const Se3& pose = r.match.solution.map_from_base;
    if ((pose.translation - believed.translation).norm() > kSameViewM) continue;
    adopt(view.frame.time_s, r);
    return;
  }
}

/// Another place has more votes than the one believed: lost, until the next view votes too.
void Localizer::Impl::give_way() {
  const PlaceVotes kept = votes;
  lose();
  votes = kept;
}

void Localizer::Impl::adopt(double time_s, const Relocalization& place) {
  const PoseSolution& solution = place.match.solution;
  motion.place(time_s, solution.map_from_base, kFixSigmaM, kFixSigmaRad);
  motion.correct(time_s, solution);
  has_pose = true;
  state = State::kConfirming;
  was_sure = false;
  misses = 0;
  doubt = false;
  contradicted_since_s.reset();
  evidence = {};
  evidence.inliers = telling(place.match.matches);
  last_fix_s = time_s;
  tracked.clear();
  for (const FeatureMatch& m : place.match.matches) tracked.push_back(m.landmark);
  count_votes();
}

int Localizer::Impl::telling(const std::vector<FeatureMatch>& matches) const {
  return static_cast<int>(std::count_if(matches.begin(), matches.end(), [&](const auto& m) {
    const bool stands = !motion.planar() || is_upright(map.landmark(m.landmark));
    return stands && !repeated[static_cast<std::size_t>(m.landmark)];
  }));
}

/// Whether what the view shows cannot be at `pose`: the map's landmarks are not where they should
/// be, the depth scan does not lie on its walls, or much is there and nothing matches.
bool Localizer::Impl::contradicts(const View& view, const std::vector<int>& landmarks,
                                  const Se3& pose, int inliers) {
  const DepthAgreement depth = depth_agreement(map, landmarks, view.frame, pose, motion.planar());
  ScanAgreement scan;
  if (field) scan = scan_agreement(*field, view.scan, to_planar(pose));
  evidence.depth_share = depth.judged() >= kEnoughLandmarks ? depth.share() : 1.0;
  evidence.scan_share = scan.points >= kEnoughPoints ? scan.share : 1.0;
  evidence.matched_share =
      std::min(1.0, static_cast<double>(inliers) / std::max(1, depth.at_depth));
  return evidence.depth_share < kLeastDepthShare || evidence.scan_share < kLeastScanShare ||
         (depth.at_depth >= kEnoughAtDepth && evidence.matched_share < kLeastMatchedShare);
}

void Localizer::Impl::follow(const View& view) {
  const MotionPrediction prediction = motion.predict(view.frame.time_s);
  const LocalMap local = select_local_map(map, tracked, prediction.prior.map_from_base);
  const TrackResult result = track_frame(map, local.landmarks, view.features, prediction);
  const bool fits =
      result.status == TrackStatus::kTracked &&
      !contradicts(view, local.landmarks, result.solution.map_from_base, result.solution.inliers);
  if (fits) {
    take_in(view, result);
  } else {
    miss(view, local.landmarks, prediction);
  }
}

void Localizer::Impl::take_in(const View& view, const TrackResult& result) {
  const double time_s = view.frame.time_s;
  motion.correct(time_s, result.solution);
  tracked.clear();
  for (const FeatureMatch& m : result.matches) tracked.push_back(m.landmark);
  if (time_s - last_fix_s > kReconfirmAfterS && state == State::kTracking) {
    state = State::kConfirming;
    evidence.agreeing_frames = 0;
  }
  ++evidence.agreeing_frames;
  evidence.inliers = telling(result.matches);
  last_fix_s = time_s;
  misses = 0;
  doubt = false;
  contradicted_since_s.reset();
}

void Localizer::Impl::miss(const View& view, const std::vector<int>& local_landmarks,
                           const MotionPrediction& prediction) {
  const double time_s = view.frame.time_s;
  const Se3& believed = prediction.prior.map_from_base;
  motion.miss(time_s);
  tracked.clear();
  ++misses;
  doubt = view.shows_plenty();
  const bool contradicted =
      doubt && (map_knows_view(believed) || contradicts(view, local_landmarks, believed, kPlenty));
  if (contradicted && !contradicted_since_s) contradicted_since_s = time_s;
  const bool unconfirmed = state == State::kConfirming && misses >= kForgetFixAfter;
  const bool carried_off = contradicted_since_s && time_s - *contradicted_since_s >= kLostAfterS;
  if (unconfirmed || carried_off || prediction.sigma_position_m > config.localizer.lost_sigma_m) {
    lose();
  }
}

/// Enough frames agree, and the whole map has no better place for what they show.
bool Localizer::Impl::is_convincing() const {
  if (evidence.agreeing_frames < config.localizer.confirmation_frames) return false;
  // Blind for a moment only, or told where to look: that speaks for the place, too.
  if (was_sure || prior) {
    return evidence.scan_share >= kStillScanShare && evidence.matched_share >= kStillMatched &&
           evidence.rival_share <= kMostRivalTracking;
  }
  if (moved_away && evidence.agreeing_frames < kFramesAfterLoss) return false;
  const double sure_recognitions = motion.planar() ? kSureRecognitions : kSureRecognition;
  return evidence.scan_share >= kSureScanShare && evidence.depth_share >= kSureDepthShare &&
         evidence.matched_share >= kSureMatched && evidence.inliers >= kSureTelling &&
         evidence.recognitions >= sure_recognitions && evidence.rival_share <= kMostRival &&
         confidence_of(evidence) >= kOkConfidence;
}

void Localizer::Impl::on_frame(const mrpt::obs::CObservation3DRangeScan& scan) {
  ++frames;
  View view;
  view.frame = camera_frame_from(scan, map.camera());
  note_interval(view.frame.time_s);
  if (view.frame.gray.empty()) return;
  view.features = extract_features(view.frame, map.camera(), config.features, config.depth);
  if (field && !view.frame.depth.empty()) {
    view.scan = obstacle_points(view.frame.depth, view.frame.depth_unit_m, map.camera(),
                                map.base_from_camera(), config);
  }
  votes.fade();
  if (!motion.planar()) votes.clear();  // without odometry only one view's votes can be compared
  if (state != State::kSearching) follow(view);
  const bool spot_check = frames % kSpotCheckEvery == 0;
  if (state == State::kSearching) {
    search(view);
  } else if (state == State::kConfirming || misses > 0 || spot_check) {
    const LocalizerEvidence kept = evidence;
    look_everywhere(view);
    evidence = kept;
    count_votes();
    if (evidence.rival_share > 0.5) give_way();
  }
  const MotionPrediction now = motion.predict(view.frame.time_s);
  evidence.sigma_position_m = now.sigma_position_m;
  evidence.sigma_heading_rad = now.sigma_heading_rad;
  if (state == State::kConfirming && is_convincing()) {
    state = State::kTracking;
    was_sure = true;
    moved_away = false;
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
  e.confidence = (doubt ? kDoubtfulShare : 1.0) * confidence_of(evidence);
  const bool fresh =
      !doubt && !camera_is_silent(time_s) && evidence.unseen_s <= config.localizer.degraded_after_s;
  const bool sure = state == State::kTracking && evidence.rival_share <= kMostRivalTracking &&
                    e.confidence >= kOkConfidence;
  e.health = sure && fresh ? Health::kOk : Health::kDegraded;
  return e;
}

Localizer::Localizer(const SlamConfig& config, const Rig& rig, const maps::SavedMap& map,
                     const std::optional<PosePrior>& prior)
    : impl_(std::make_unique<Impl>(config, rig, map, prior)) {}
Localizer::~Localizer() = default;

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
