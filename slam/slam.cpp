#include "slam/slam.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "slam/bundle_adjustment.h"
#include "slam/camera_frame.h"
#include "slam/features.h"
#include "slam/keyframe_codec.h"
#include "slam/landmark_map.h"
#include "slam/local_map.h"
#include "slam/localizer_depth_check.h"
#include "slam/loop_closer.h"
#include "slam/map_storage.h"
#include "slam/motion_model.h"
#include "slam/place_match.h"
#include "slam/surroundings.h"
#include "slam/tracker.h"
#include "slam/tracking_health.h"
#include "slam/trajectory_history.h"

namespace rovigo::slam {

namespace {

// Between frames the trajectory holds dead-reckoned poses, so that no moment is farther than 0.02 s
// from one at any frame rate the wheels outpace.
constexpr double kDeadReckonedEveryS = 0.02;
constexpr int kMinFirstFeatures = 50;      // with depth, to start a map on
constexpr int kTellingLandmarks = 40;      // that should be in view: fewer prove nothing
constexpr double kAgreeingShare = 0.5;     // of them that must be at their depth
constexpr double kWorthlessSigmaM = 0.5;   // dead reckoning beyond it holds nobody back from a jump
constexpr int kSearchEverywhereEvery = 5;  // frames without a match
constexpr int kSearchWhenLostEvery = 2;
constexpr int kFewInliers = 120;  // fewer leave the heading to noise: walls are asked too
constexpr int kMinWallPoints = 30;
constexpr double kMinWallShare = 0.7;   // of the points that must lie on the walls
constexpr double kWallStep = 1.0;       // a step beyond this is no correction
constexpr int kWallKeyframes = 5;       // whose walls are looked at together
constexpr double kBlindSpacing = 1.25;  // of keyframes in places that show nothing
constexpr double kFoundSigmaM = 0.05;   // of a pose found by recognising the place
constexpr double kFoundSigmaRad = 0.03;
constexpr double kSurprisingM = 0.15;
constexpr int kFinalIterations = 8;
// What one step from keyframe to keyframe adds to the uncertainty, at rest and by its length.
constexpr double kHopM = 0.002, kHopShare = 0.004;
constexpr double kHopRad = 0.001, kHopRadShare = 0.002;
constexpr double kFrameIsLateS = 0.3;  // without one, nothing can be called tracked

bool is_convincing(const WallMatch& match) {
  return match.points >= kMinWallPoints && match.inlier_share >= kMinWallShare;
}

/// How far a match leads away from the prior, in units of 5 cm and 30 mrad.
double step_of(const WallMatch& match, const TPose2D& prior) {
  const TPose2D& at = match.look.map_from_base;
  return std::hypot(at.x - prior.x, at.y - prior.y) / 0.05 +
         std::abs(maps::wrap_angle(at.phi - prior.phi)) / 0.03;
}

/// What walls alone say: the match was held by the prior where they are silent.
MotionLink link_of(const WallMatch& match, const TPose2D& from) {
  Eigen::Matrix3d information = match.look.information;
  information.diagonal() += Eigen::Vector3d(1.0, 1.0, 1.0);  // 1 m, 1 rad: nothing
  const Eigen::Vector3d step = -information.ldlt().solve(match.look.gradient);
  const TPose2D& at = match.look.map_from_base;
  const TPose2D to{at.x + step.x(), at.y + step.y(), at.phi + step.z()};
  Eigen::Matrix3d from_map = Eigen::Matrix3d::Identity();
  from_map.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-from.phi).toRotationMatrix();
  MotionLink link;
  link.from_from_to = maps::compose(maps::inverse(from), to);
  link.covariance = from_map * information.inverse() * from_map.transpose();
  return link;
}

}  // namespace

struct Slam::Impl {
  Impl(const SlamConfig& settings, const Rig& r)
      : config(settings),
        rig(r),
        camera(r.camera),
        base_from_camera(r.has_extrinsics ? from_mrpt(r.base_from_camera)
                                          : from_mrpt(base_from_optical({}))),
        map(settings, camera, base_from_camera),
        motion(settings, r),
        loops(settings, motion.planar()),
        surroundings(settings, camera, base_from_camera, motion.planar()) {}

  void begin(double time_s);
  void dead_reckon(double time_s);
  PoseEstimate on_frame(const mrpt::obs::CObservation3DRangeScan& scan);
  Se3 follow_walls(const CameraFrame& frame, const Se3& pose);
  std::vector<int> last_keyframes() const;
  std::vector<PlacedWalls> placed_walls(const std::vector<int>& keyframes) const;
  void link_walls(int keyframe, const std::vector<int>& earlier);
  TrackResult track(double time_s, const FeatureSet& features, const MotionPrediction& prediction);
  void recover(double time_s, const FeatureSet& features, TrackResult& result);
  void move_to(double time_s, const Se3& seen, const Se3& believed, int keyframe);
  ViewVerdict verdict_on(const CameraFrame& frame, const Se3& pose) const;
  void judge(const CameraFrame& frame, bool tracked, const Se3& pose);
  void remember_tracked(const TrackResult& result);
  bool frame_joins_map(const TrackResult& result, const FeatureSet& features,
                       const Se3& pose) const;
  void spread_uncertainty(const Keyframe& parent, Keyframe& child, TrackStatus status);
  void insert_keyframe(const CameraFrame& frame, FeatureSet features, const TrackResult& result,
                       const Se3& pose);
  std::vector<MotionLink> links() const;
  void look_for_loop(double time_s);
  void adjust_everything();
  void remember_pose(double time_s, const Se3& pose, bool is_camera_frame);
  PoseEstimate estimate(double time_s, const Se3& pose);

  SlamConfig config;
  Rig rig;
  CameraModel camera;
  Se3 base_from_camera;
  LandmarkMap map;
  MotionModel motion;
  LoopCloser loops;
  std::vector<PoseGraphEdge> edges;
  TrajectoryHistory history;
  Surroundings surroundings;
  LocalMap local;
  TrackingHealth health;
  std::vector<int> tracked_landmarks;
  SlamSummary counters;
  bool begun = false;
  double last_frame_s = 0.0;
  int anchor = -1;  ///< keyframe that poses are held against: last seen, or made
  int misses = 0;   ///< frames in a row that matched nothing

  /// A jump to a place recognised, until the next frames have confirmed it.
  struct Jump {
    double since_s = 0.0, until_s = 0.0;  ///< of the poses that were believed in vain
    int keyframe = -1;
    Se3 new_map_from_old_map;
  };
  std::optional<Jump> jump;

  WallScan walls;  ///< of the frame at hand, where corners were of no use
  std::vector<MotionLink> wall_links;
};

void Slam::Impl::begin(double time_s) {
  if (begun) return;
  begun = true;
  motion.place(time_s, Se3{}, 0.0, 0.0);  // the map frame starts here
}

void Slam::Impl::dead_reckon(double time_s) {
  if (!motion.planar() || time_s - history.last_time_s() < kDeadReckonedEveryS) return;
  remember_pose(time_s, motion.predict(time_s).prior.map_from_base, false);
}

void Slam::Impl::remember_pose(double time_s, const Se3& pose, bool is_camera_frame) {
  const Se3 relative = anchor < 0 ? pose : map.keyframe(anchor).map_from_base.inverse() * pose;
  history.add(time_s, anchor, relative, is_camera_frame);
}

TrackResult Slam::Impl::track(double time_s, const FeatureSet& features,
                              const MotionPrediction& prediction) {
  if (map.keyframes().empty()) return {};
  local = select_local_map(map, tracked_landmarks, prediction.prior.map_from_base);
  TrackResult result = track_frame(map, local.landmarks, features, prediction);
  if (result.status != TrackStatus::kTracked) recover(time_s, features, result);
  if (result.status == TrackStatus::kTracked) misses = 0;
  return result;
}

/// Without a usable prediction: the last known surroundings by appearance, then the whole map.
void Slam::Impl::recover(double time_s, const FeatureSet& features, TrackResult& result) {
  ++misses;
  const auto seed = static_cast<std::uint64_t>(counters.camera_frames);
  PlaceMatch found = match_place(map, local.landmarks, local.landmarks, features, motion.planar(),
                                 {.min_inliers = 2 * config.tracking.min_inliers, .seed = seed});
  int keyframe = local.reference_keyframe;
  const bool lost = health.state() == TrackingState::kLost;
  if (!found.accepted && misses % (lost ? kSearchWhenLostEvery : kSearchEverywhereEvery) == 0) {
    const Relocalization place = loops.relocalizer().find(
        map, features, motion.planar(), std::nullopt, {},
        {.min_inliers = config.localizer.relocalization_inliers, .seed = seed});
    found = place.match;
    keyframe = place.keyframe;
  }
  if (!found.accepted) return;
  const MotionPrediction believed = motion.predict(time_s);
  const Se3& seen = found.solution.map_from_base;
  const double apart = (believed.prior.map_from_base.translation - seen.translation).norm();
  if (apart > kSurprisingM + 4.0 * believed.sigma_position_m) {
    // A look-alike, unless something has shown that the prediction is worth nothing.
    if (motion.planar() && !lost && believed.sigma_position_m < kWorthlessSigmaM) return;
    move_to(time_s, seen, believed.prior.map_from_base, keyframe);
  }
  result.status = TrackStatus::kTracked;
  result.solution = found.solution;
  result.matches = found.matches;
}

void Slam::Impl::move_to(double time_s, const Se3& seen, const Se3& believed, int keyframe) {
  const bool doubted = health.state() != TrackingState::kTracking;
  const double since_s = jump ? jump->since_s : doubted ? health.doubted_since_s() : time_s;
  jump = Jump{since_s, time_s, keyframe, seen * believed.inverse()};
  motion.place(time_s, seen, kFoundSigmaM, kFoundSigmaRad);
  motion.cut_link();
  health.found_elsewhere();
}

/// The landmarks that should be in view against the depth image; features need not be asked.
ViewVerdict Slam::Impl::verdict_on(const CameraFrame& frame, const Se3& pose) const {
  // What one keyframe alone has seen may have walked away since.
  std::vector<int> lasting;
  for (const int l : local.landmarks) {
    if (map.landmark(l).sightings.size() >= 2) lasting.push_back(l);
  }
  const DepthAgreement view = depth_agreement(map, lasting, frame, pose, motion.planar());
  if (view.judged() + view.hidden < kTellingLandmarks) return ViewVerdict::kSilent;
  if (view.hidden > view.judged()) return ViewVerdict::kHidden;
  return view.share() < kAgreeingShare ? ViewVerdict::kContradicts : ViewVerdict::kAgrees;
}

/// What this frame says about the pose believed; a jump that is confirmed mends the poses before.
void Slam::Impl::judge(const CameraFrame& frame, bool tracked, const Se3& pose) {
  health.update({.time_s = frame.time_s,
                 .tracked = tracked,
                 .verdict = tracked ? ViewVerdict::kAgrees : verdict_on(frame, pose),
                 .carried = motion.carried()});
  if (!jump || health.state() == TrackingState::kConfirming) return;
  if (health.state() == TrackingState::kTracking) {
    history.reanchor(jump->since_s, jump->until_s, map, jump->keyframe, jump->new_map_from_old_map);
    jump.reset();
  }
}

void Slam::Impl::remember_tracked(const TrackResult& result) {
  tracked_landmarks.clear();
  for (const int l : result.visible) ++map.landmark(l).predicted;
  for (const FeatureMatch& m : result.matches) {
    ++map.landmark(m.landmark).tracked;
    tracked_landmarks.push_back(m.landmark);
  }
}

/// A rover that knows no corner in view still sees the walls of where it has just been.
Se3 Slam::Impl::follow_walls(const CameraFrame& frame, const Se3& pose) {
  if (!motion.planar() || frame.depth.empty() || health.state() == TrackingState::kLost) {
    return pose;
  }
  walls = wall_scan(frame, camera, base_from_camera, config);
  const WallMatch match = match_walls(placed_walls(last_keyframes()), walls, to_planar(pose),
                                      motion.dead_reckoning().pose_covariance());
  // A person's flank is no wall: it asks for a step that wheels and gyro do not believe.
  const bool plausible = is_convincing(match) && step_of(match, to_planar(pose)) < kWallStep;
  return plausible ? motion.correct(match.look) : pose;
}

/// The keyframe at hand and those before it that may show the same walls.
std::vector<int> Slam::Impl::last_keyframes() const {
  std::vector<int> out;
  for (int k = anchor; k >= 0 && k > anchor - kWallKeyframes; --k) out.push_back(k);
  return out;
}

std::vector<PlacedWalls> Slam::Impl::placed_walls(const std::vector<int>& keyframes) const {
  std::vector<PlacedWalls> out;
  for (const int k : keyframes) {
    out.push_back({&map.keyframe(k).walls, to_planar(map.keyframe(k).map_from_base)});
  }
  return out;
}

/// Ties a new keyframe to those before it by the walls they see in common.
void Slam::Impl::link_walls(int keyframe, const std::vector<int>& earlier) {
  const Keyframe& now = map.keyframe(keyframe);
  for (const int k : earlier) {
    const WallMatch match = match_walls(placed_walls({k}), now.walls, to_planar(now.map_from_base),
                                        motion.dead_reckoning().pose_covariance());
    if (!is_convincing(match) || step_of(match, to_planar(now.map_from_base)) > kWallStep) continue;
    MotionLink link = link_of(match, to_planar(map.keyframe(k).map_from_base));
    link.from = k;
    link.to = keyframe;
    link.begin_s = map.keyframe(k).time_s;
    link.end_s = now.time_s;
    wall_links.push_back(link);
  }
}

/// Tracked frames join where they show something new. A rover that sees nothing it knows still
/// knows where it is: its frames join by dead reckoning, so that the map goes on behind a plain
/// corridor, and a plain corridor itself becomes a chain of waypoints that the back end can bend.
bool Slam::Impl::frame_joins_map(const TrackResult& result, const FeatureSet& features,
                                 const Se3& pose) const {
  if (map.keyframes().empty()) {
    const auto with_depth = std::count_if(features.features().begin(), features.features().end(),
                                          [](const Feature& f) { return f.depth_m > 0; });
    return motion.planar() || with_depth >= kMinFirstFeatures;
  }
  if (!health.is_trusted()) return false;
  if (result.status == TrackStatus::kTracked) {
    return wants_keyframe(map, local, result, features, pose);
  }
  if (!motion.planar()) return false;
  const Se3& last = map.keyframes().back().map_from_base;
  const double spacing = keyframe_spacing(last, pose, config.tracking);
  return spacing > kBlindSpacing;
}

/// A keyframe is known against the map's first one as well as its parent, and a little worse.
void Slam::Impl::spread_uncertainty(const Keyframe& parent, Keyframe& child, TrackStatus status) {
  const Se3 step = parent.map_from_base.inverse() * child.map_from_base;
  const double distance = step.translation.norm(), turn = so3_log(step.rotation).norm();
  const MotionPrediction now = motion.predict(child.time_s);
  const bool blind = status != TrackStatus::kTracked;
  const double hop_m = kHopM + kHopShare * distance + (blind ? now.sigma_position_m : 0.0);
  const double hop_rad = kHopRad + kHopRadShare * turn + (blind ? now.sigma_heading_rad : 0.0);
  child.sigma_m = std::hypot(parent.sigma_m, hop_m, parent.sigma_rad * distance);
  child.sigma_rad = std::hypot(parent.sigma_rad, hop_rad);
}

void Slam::Impl::insert_keyframe(const CameraFrame& frame, FeatureSet features,
                                 const TrackResult& result, const Se3& pose) {
  Keyframe k;
  k.time_s = frame.time_s;
  k.color_jpeg = encode_color(frame.color);
  k.depth_png = encode_depth(frame);
  k.map_from_base = pose;
  k.features = std::move(features);
  k.landmark_of.assign(k.features.size(), -1);
  for (const FeatureMatch& m : result.matches) {
    k.landmark_of[static_cast<std::size_t>(m.feature)] = m.landmark;
  }
  const bool blind = !walls.empty();
  if (motion.planar()) {
    k.walls = blind ? walls : wall_scan(frame, camera, base_from_camera, config);
  }
  if (anchor >= 0) spread_uncertainty(map.keyframe(anchor), k, result.status);
  const std::vector<int> earlier = last_keyframes();
  const int id = map.add_keyframe(std::move(k));
  motion.mark_keyframe(id, frame.time_s);
  if (blind) link_walls(id, earlier);
  local.reference_keyframe = anchor = id;
  tracked_landmarks.clear();
  for (const int l : map.keyframe(id).landmark_of) {
    if (l >= 0) tracked_landmarks.push_back(l);
  }
  map.cull(local.landmarks);
  for (const PoseGraphEdge& e : tracked_edges(map, id, motion.planar())) edges.push_back(e);
  look_for_loop(frame.time_s);
}

/// Everything that ties keyframes but corners: wheels with gyro, and walls.
std::vector<MotionLink> Slam::Impl::links() const {
  std::vector<MotionLink> all = motion.links();
  all.insert(all.end(), wall_links.begin(), wall_links.end());
  return all;
}

void Slam::Impl::look_for_loop(double time_s) {
  const MotionPrediction now = motion.predict(time_s);
  const int newest = static_cast<int>(map.keyframes().size()) - 1;
  const auto loop = loops.detect(map, {now.sigma_position_m, now.sigma_heading_rad});
  if (!loop || !config.loop.loop_closure) return;
  const Se3 before = map.keyframe(newest).map_from_base;
  if (!close_loop(map, edges, links(), *loop)) return;
  ++counters.loop_closures;
  const Keyframe& seen_before = map.keyframe(loop->edge.from);
  Keyframe& now_known = map.keyframe(newest);
  now_known.sigma_m =
      std::min(now_known.sigma_m, std::hypot(seen_before.sigma_m, kFoundSigmaM / 5));
  now_known.sigma_rad =
      std::min(now_known.sigma_rad, std::hypot(seen_before.sigma_rad, kFoundSigmaRad / 5));
  motion.shift(map.keyframe(newest).map_from_base * before.inverse());
}

/// The last word on all poses: everything seen, all at once.
void Slam::Impl::adjust_everything() {
  constexpr int kPasses = 2;  // the second without the sightings the first found wanting
  for (int pass = 0; pass < kPasses; ++pass) {
    adjust_bundle(map, {}, links(), {.iterations = kFinalIterations, .on_floor = motion.planar()});
  }
}

PoseEstimate Slam::Impl::estimate(double time_s, const Se3& pose) {
  const MotionPrediction now = motion.predict(time_s);
  PoseEstimate e;
  e.time_s = time_s;
  e.map_from_base = to_mrpt(pose);
  e.sigma_position_m = now.sigma_position_m;
  e.sigma_heading_rad = now.sigma_heading_rad;
  if (anchor >= 0) {
    // The filter knows the pose against the keyframe in view; that one is not known exactly either.
    e.sigma_position_m = std::hypot(e.sigma_position_m, map.keyframe(anchor).sigma_m);
    e.sigma_heading_rad = std::hypot(e.sigma_heading_rad, map.keyframe(anchor).sigma_rad);
  }
  const bool frames_come = time_s - last_frame_s < kFrameIsLateS;
  const bool bounded = now.sigma_position_m < config.localizer.lost_sigma_m;
  switch (health.state()) {
    case TrackingState::kTracking:
      e.health = frames_come ? Health::kOk : bounded ? Health::kDegraded : Health::kLost;
      e.confidence = frames_come ? 0.95 : bounded ? 0.6 : 0.0;
      break;
    case TrackingState::kReckoning:
    case TrackingState::kConfirming:
      e.health = bounded ? Health::kDegraded : Health::kLost;
      e.confidence = bounded ? 0.6 : 0.0;
      break;
    case TrackingState::kLost:
      e.health = Health::kLost;
      break;
  }
  return e;
}

PoseEstimate Slam::Impl::on_frame(const mrpt::obs::CObservation3DRangeScan& scan) {
  const CameraFrame frame = camera_frame_from(scan, camera);
  last_frame_s = frame.time_s;
  const MotionPrediction prediction = motion.predict(frame.time_s);
  FeatureSet features;
  if (!frame.gray.empty())
    features = extract_features(frame, camera, config.features, config.depth);

  walls.clear();
  const TrackResult result = track(frame.time_s, features, prediction);
  const bool tracked = result.status == TrackStatus::kTracked;
  Se3 pose = prediction.prior.map_from_base;
  if (tracked) {
    const Se3 predicted = motion.predict(frame.time_s).prior.map_from_base;
    pose = motion.correct(frame.time_s, result.solution);
    // The first look at a place recognised is rough; those that confirm it sharpen the jump.
    if (jump) jump->new_map_from_old_map = pose * predicted.inverse() * jump->new_map_from_old_map;
    anchor = local.reference_keyframe;
    remember_tracked(result);
    if (result.solution.inliers < kFewInliers) pose = follow_walls(frame, pose);
  } else {
    motion.miss(frame.time_s);
    tracked_landmarks.clear();
    pose = follow_walls(frame, pose);
  }
  const bool first = map.keyframes().empty();
  judge(frame, tracked, pose);
  if (!frame.gray.empty() && frame_joins_map(result, features, pose)) {
    insert_keyframe(frame, std::move(features), result, pose);
    pose = map.keyframe(anchor).map_from_base;  // a loop may have moved it
  }
  remember_pose(frame.time_s, pose, true);
  if (health.is_trusted()) surroundings.look(frame, map, anchor, pose);
  ++counters.camera_frames;
  counters.tracked_frames += tracked && health.state() == TrackingState::kTracking;
  if (first && !map.keyframes().empty()) ++counters.tracked_frames;
  return estimate(frame.time_s, pose);
}

Slam::Slam(const SlamConfig& config, const Rig& rig) : impl_(std::make_unique<Impl>(config, rig)) {}
Slam::~Slam() = default;

std::optional<PoseEstimate> Slam::process(const mrpt::obs::CObservation& observation) {
  Impl& s = *impl_;
  const double time_s = time_of(observation);
  s.begin(time_s);
  if (const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation)) {
    return s.on_frame(*scan);
  }
  if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation)) {
    s.motion.add(*imu);
  } else if (const auto* wheels =
                 dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
    s.motion.add(*wheels);
  }
  s.dead_reckon(time_s);
  const bool late = s.last_frame_s > 0.0 && time_s - s.last_frame_s >= kFrameIsLateS;
  if (!late || !s.motion.planar()) return std::nullopt;
  return s.estimate(time_s, s.motion.predict(time_s).prior.map_from_base);
}

maps::SavedMap Slam::finish() {
  Impl& s = *impl_;
  s.adjust_everything();
  maps::SavedMap out;
  out.metadata.software_version = ROVIGO_VERSION;
  out.metadata.camera = s.rig.camera;
  out.metadata.base_from_camera = to_mrpt(s.base_from_camera);
  out.keyframes = store_keyframes(s.map);
  out.edges = store_edges(s.edges);
  out.trajectory = s.history.poses(s.map);
  out.grid = s.surroundings.render(s.map);
  return out;
}

SlamSummary Slam::summary() const {
  SlamSummary out = impl_->counters;
  out.keyframes = static_cast<int>(impl_->map.keyframes().size());
  return out;
}

}  // namespace rovigo::slam
