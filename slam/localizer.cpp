#include "slam/localizer.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>

#include "slam/camera_frame.h"
#include "slam/local_map.h"
#include "slam/map_storage.h"
#include "slam/motion_model.h"
#include "slam/relocalizer.h"

namespace rovigo::slam {

namespace {

constexpr double kFixSigmaM = 0.05;  // of a freshly recognised place, before frames confirm it
constexpr double kFixSigmaRad = 0.03;
constexpr double kPriorGates = 4.0;   // sigmas around a given pose that are searched
constexpr int kLostAfterFrames = 12;  // that show plenty and match nothing: carried elsewhere
constexpr int kPlenty = 150;          // features; fewer and the camera may be covered or dark
constexpr int kForgetFixAfter = 3;    // unconfirmed frames
// A view this near a mapped one has to match it; elsewhere the map knows nothing to contradict.
constexpr double kSameViewM = 0.7;
constexpr double kSameViewRad = 0.45;

}  // namespace

struct Localizer::Impl {
  enum class State { kSearching, kConfirming, kTracking };

  Impl(const SlamConfig& settings, const Rig& r, const maps::SavedMap& saved,
       const std::optional<PosePrior>& given)
      : config(settings), map(restore_landmark_map(saved, settings)), motion(settings, r) {
    for (const Keyframe& k : map.keyframes()) relocalizer.add(map, k.id);
    if (given) {
      prior = PoseRegion{from_planar(given->map_from_base), kPriorGates * given->sigma_position_m,
                         kPriorGates * given->sigma_heading_rad};
      prior_sigma_m = given->sigma_position_m;
      prior_sigma_rad = given->sigma_heading_rad;
    }
  }

  void begin(double time_s);
  void on_frame(const mrpt::obs::CObservation3DRangeScan& scan);
  void search(double time_s, const FeatureSet& features);
  void follow(double time_s, const FeatureSet& features);
  void lose();
  bool map_knows_view(const Se3& map_from_base) const;
  PoseEstimate estimate(double time_s);

  SlamConfig config;
  LandmarkMap map;
  MotionModel motion;
  Relocalizer relocalizer;
  std::optional<PoseRegion> prior;
  double prior_sigma_m = 0.0, prior_sigma_rad = 0.0;

  State state = State::kSearching;
  bool begun = false;
  bool has_pose = false;  ///< some pose to carry on from, right or not
  std::vector<int> tracked;
  int frames = 0;
  int confirmations = 0;
  int misses = 0;              ///< frames in a row that matched nothing
  int misses_with_plenty = 0;  ///< of them, those where the map should have matched
  int inliers = 0;             ///< of the last match
  double last_fix_s = -1e9;
};

void Localizer::Impl::begin(double time_s) {
  if (begun) return;
  begun = true;
  if (!prior) return;
  motion.place(time_s, prior->map_from_base, prior_sigma_m, prior_sigma_rad);
  has_pose = true;
}

void Localizer::Impl::lose() {
  state = State::kSearching;
  confirmations = 0;
  tracked.clear();
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

void Localizer::Impl::search(double time_s, const FeatureSet& features) {
  const PlaceMatchConfig place{.min_inliers = config.localizer.relocalization_inliers,
                               .seed = static_cast<std::uint64_t>(frames)};
  const Relocalization found = relocalizer.find(map, features, motion.planar(), prior, {}, place);
  if (found.keyframe < 0) return;
  motion.place(time_s, found.match.solution.map_from_base, kFixSigmaM, kFixSigmaRad);
  motion.correct(time_s, found.match.solution);
  has_pose = true;
  state = State::kConfirming;
  confirmations = 1;
  misses = misses_with_plenty = 0;
  inliers = found.match.solution.inliers;
  tracked.clear();
  for (const FeatureMatch& m : found.match.matches) tracked.push_back(m.landmark);
}

void Localizer::Impl::follow(double time_s, const FeatureSet& features) {
  const MotionPrediction prediction = motion.predict(time_s);
  const LocalMap local = select_local_map(map, tracked, prediction.prior.map_from_base);
  const TrackResult result = track_frame(map, local.landmarks, features, prediction);
  if (result.status == TrackStatus::kTracked) {
    motion.correct(time_s, result.solution);
    tracked.clear();
    for (const FeatureMatch& m : result.matches) tracked.push_back(m.landmark);
    inliers = result.solution.inliers;
    misses = misses_with_plenty = 0;
    last_fix_s = time_s;
    if (state == State::kConfirming && ++confirmations > config.localizer.confirmation_frames) {
      state = State::kTracking;
      prior.reset();  // it has done its work; from here on the map decides
    }
    return;
  }
  motion.miss(time_s);
  ++misses;
  if (static_cast<int>(features.size()) >= kPlenty &&
      map_knows_view(prediction.prior.map_from_base)) {
    ++misses_with_plenty;
  }
  const bool unconfirmed = state == State::kConfirming && misses >= kForgetFixAfter;
  const bool carried_off = misses_with_plenty >= kLostAfterFrames;
  if (unconfirmed || carried_off || prediction.sigma_position_m > config.localizer.lost_sigma_m) {
    lose();
  }
}

void Localizer::Impl::on_frame(const mrpt::obs::CObservation3DRangeScan& scan) {
  ++frames;
  const CameraFrame frame = camera_frame_from(scan, map.camera());
  if (frame.gray.empty()) return;
  const FeatureSet features = extract_features(frame, map.camera(), config.features, config.depth);
  if (state != State::kSearching) follow(frame.time_s, features);
  if (state == State::kSearching) search(frame.time_s, features);
}

PoseEstimate Localizer::Impl::estimate(double time_s) {
  PoseEstimate e;
  e.time_s = time_s;
  if (!has_pose) return e;
  const MotionPrediction now = motion.predict(time_s);
  e.map_from_base = to_mrpt(now.prior.map_from_base);
  e.sigma_position_m = now.sigma_position_m;
  e.sigma_heading_rad = now.sigma_heading_rad;
  // A frame that shows plenty and fits nothing says at once that something is wrong.
  const bool fresh =
      misses_with_plenty == 0 && time_s - last_fix_s <= config.localizer.degraded_after_s;
  const double support = 1.0 - std::exp(-inliers / 25.0);
  if (state == State::kTracking) {
    e.health = fresh ? Health::kOk : Health::kDegraded;
    e.confidence = (fresh ? 0.98 : 0.7) * support;
  } else if (state == State::kConfirming) {
    e.health = Health::kDegraded;
    e.confidence = 0.5 * support;
  }
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
  } else if (const auto* wheels =
                 dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
    l.motion.add(*wheels);
  }
  return l.estimate(time_s);
}

}  // namespace rovigo::slam
