#include "slam/localizer.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "slam/localizer_impl.h"
#include "slam/map_storage.h"

namespace rovigo::slam {

namespace {

constexpr double kPriorGates = 4.0;   // sigmas around a given pose that are searched
constexpr int kSpotCheckEvery = 15;   // frames: does the whole map agree with what is tracked?
constexpr double kFrameGaps = 2.5;    // usual intervals without a frame: the camera fell silent
constexpr double kLeastBelief = 0.5;  // in a place not yet confirmed, to call it more than LOST
constexpr double kMostRivalTracking = 0.35;  // share of the votes that another place may have
// Of the confidence, while a frame does not fit: after a jump of the view, and while it goes on.
constexpr double kBrokenShare = 0.3, kUnbrokenShare = 0.95;

}  // namespace

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
  believe_prior();
}

/// Somebody says where it is: that is where frames are compared first, as surely as was said.
void Localizer::Impl::believe_prior() {
  state = State::kConfirming;
  vouched = true;
}

void Localizer::Impl::believe_nothing() {
  state = State::kSearching;
  was_sure = vouched = false;
  evidence = {};
  misses = 0;
  doubt = false;
  contradicted_since_s.reset();
  unvouched_since_s.reset();
  tracked.clear();
}

/// The rover was carried: what was seen before the view last jumped belongs to another place, and
/// so does everything while it is being carried.
void Localizer::Impl::lose(double time_s) {
  believe_nothing();
  finder.clear_before(motion.carried() ? time_s : jumped_s);
}

/// A guess seems wrong: nobody carried the rover, so what was seen on the way stays true. It is
/// given up for another place only; contradictions add up until there is one.
void Localizer::Impl::drop_guess(double time_s) {
  const Se3 here = believed(time_s), odom = odom_from_base(time_s);
  finder.refute(here, odom);
  if (!finder.is_best(here, odom)) {
    believe_nothing();
    return;
  }
  evidence.agreeing_frames = 0;
  misses = 0;
  contradicted_since_s.reset();
}

void Localizer::Impl::note_interval(double time_s) {
  const double interval = time_s - last_frame_s;
  if (interval > 0.0 && interval < 1.0) frame_interval_s += 0.2 * (interval - frame_interval_s);
  last_frame_s = time_s;
}

bool Localizer::Impl::camera_is_silent(double time_s) const {
  return time_s - last_frame_s > kFrameGaps * frame_interval_s;
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
  const bool goes_on = continuity.follows(view.frame, odom_from_base(view.frame.time_s));
  const bool told = frames == 1 && vouched;  // the first view goes on from what was said
  if (!goes_on) jumped_s = frame.time_s;
  const bool jumps = !goes_on && !broken;  // once: a view that tells nothing never goes on
  broken |= (!goes_on && !told) || !motion.planar();
  const bool is_new = finder.see(view.frame.time_s, odom_from_base(view.frame.time_s), view.scan,
                                 view.frame.depth, view.frame.depth_unit_m, jumps);
  const bool believed_before = state != State::kSearching;
  if (believed_before) follow(view);
  const bool just_lost = believed_before && state == State::kSearching;  // says so for a frame
  const bool spot_check = frames % kSpotCheckEvery == 0;
  if (!just_lost && (state != State::kTracking || misses > 0 || spot_check)) {
    const bool recognized = look_everywhere(view);
    judge_places(view, is_new);
    if (state != State::kSearching && motion.planar()) look_beside(view, recognized);
    weigh_support(view.frame.time_s);
  }
  const MotionPrediction now = motion.predict(view.frame.time_s);
  evidence.sigma_position_m = now.sigma_position_m;
  evidence.sigma_heading_rad = now.sigma_heading_rad;
  if (state == State::kConfirming && is_convincing()) {
    state = State::kTracking;
    was_sure = true;
    vouched = false;
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
