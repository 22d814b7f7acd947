#include "slam/slam.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "slam/back_end.h"
#include "slam/camera_frame.h"
#include "slam/features.h"
#include "slam/keyframe_culling.h"
#include "slam/keyframe_maker.h"
#include "slam/keyframe_uncertainty.h"
#include "slam/landmark_map.h"
#include "slam/local_map.h"
#include "slam/map_storage.h"
#include "slam/motion_model.h"
#include "slam/pose_report.h"
#include "slam/recovery.h"
#include "slam/surroundings.h"
#include "slam/tracker.h"
#include "slam/tracking_health.h"
#include "slam/trajectory_history.h"
#include "slam/view_continuity.h"
#include "slam/view_verdict.h"
#include "slam/wall_revisits.h"
#include "slam/wall_ties.h"

namespace rovigo::slam {

namespace {

// Between frames the trajectory holds dead-reckoned poses, so that no moment is farther than 0.02 s
// from one at any frame rate the wheels outpace.
constexpr double kDeadReckonedEveryS = 0.02;
constexpr int kFewInliers = 120;  // fewer leave the heading to noise: walls are asked too

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
        continuity(camera, base_from_camera),
        back_end(settings, map, motion.planar()),
        surroundings(settings, camera, base_from_camera, motion.planar()),
        recovery(settings, r, map, surroundings, back_end.relocalizer(), motion, health),
        wall_ties(settings) {}

  void begin(double time_s);
  void dead_reckon(double time_s);
  PoseEstimate on_frame(const mrpt::obs::CObservation3DRangeScan& scan);
  TrackResult track(const CameraFrame& frame, const FeatureSet& features);
  Se3 believe(const CameraFrame& frame, const TrackResult& result);
  Se3 follow_walls(const CameraFrame& frame, const Se3& pose);
  void judge(const CameraFrame& frame, bool tracked, const Se3& pose);
  void remember_tracked(const TrackResult& result);
  void insert_keyframe(const CameraFrame& frame, FeatureSet features, const TrackResult& result,
                       const Se3& pose);
  void cull_keyframes();
  std::vector<MotionLink> links() const;
  void remember_pose(double time_s, const Se3& pose, bool is_camera_frame);
  PoseEstimate report(double time_s, const Se3& pose);

  SlamConfig config;
  Rig rig;
  CameraModel camera;
  Se3 base_from_camera;
  LandmarkMap map;
  MotionModel motion;
  TrackingHealth health;
  ViewContinuity continuity;
  BackEnd back_end;
  Surroundings surroundings;
  Recovery recovery;
  WallTies wall_ties;
  TrajectoryHistory history;
  LocalMap local;
  std::vector<int> tracked_landmarks;
  SlamSummary counters;
  bool begun = false;
  double last_frame_s = 0.0;
  int anchor = -1;  ///< keyframe that poses are held against: last seen, or made
  MapUncertainty uncertainty;
};

void Slam::Impl::begin(double time_s) {
  if (begun) return;
  begun = true;
  motion.place(time_s, Se3{}, 0.0, 0.0);  // the map frame starts here
}

PoseEstimate Slam::Impl::on_frame(const mrpt::obs::CObservation3DRangeScan& scan) {
  const CameraFrame frame = camera_frame_from(scan, camera);
  last_frame_s = frame.time_s;
  FeatureSet features;
  if (!frame.gray.empty()) {
    features = extract_features(
        frame, camera, config.features, config.depth,
        rolling_shutter_of(rig, config.tracking, motion.predict(frame.time_s).turn_rate_rad_s,
                           base_from_camera),
        surroundings.floor_under(frame));
  }

  const TrackResult result = track(frame, features);
  const bool tracked = result.status == TrackStatus::kTracked;
  Se3 pose = believe(frame, result);
  judge(frame, tracked, pose);

  const bool first = map.keyframes().empty();
  if (!frame.gray.empty() &&
      frame_joins_map(map, local, result, features, pose, health, motion.planar())) {
    insert_keyframe(frame, std::move(features), result, pose);
    pose = map.keyframe(anchor).map_from_base;  // a loop may have moved it
  }
  remember_pose(frame.time_s, pose, true);
  if (health.is_trusted()) surroundings.look(frame, map, anchor, pose);

  ++counters.camera_frames;
  const bool starts_map = first && !map.keyframes().empty();
  counters.tracked_frames += starts_map || (tracked && health.state() == TrackingState::kTracking);
  return report(frame.time_s, pose);
}

/// The frame against the landmarks around the prediction; against the whole map where that fails.
TrackResult Slam::Impl::track(const CameraFrame& frame, const FeatureSet& features) {
  const MotionPrediction prediction = motion.predict(frame.time_s);
  if (map.keyframes().empty()) return {};
  local = select_local_map(map, tracked_landmarks, prediction.prior.map_from_base);
  TrackResult result;
  if (!recovery.must_search()) {
    result = track_frame(map, local.landmarks, features, prediction);
  }
  if (result.status == TrackStatus::kTracked) {
    recovery.not_needed();
  } else {
    recovery.recover(frame, features, static_cast<std::uint64_t>(counters.camera_frames), local,
                     result);
  }
  return result;
}

/// The pose after this frame: what corners say, and walls where corners are few.
Se3 Slam::Impl::believe(const CameraFrame& frame, const TrackResult& result) {
  wall_ties.next_frame();
  const Se3 predicted = motion.predict(frame.time_s).prior.map_from_base;
  if (result.status != TrackStatus::kTracked) {
    motion.miss(frame.time_s);
    tracked_landmarks.clear();
    return follow_walls(frame, predicted);
  }
  const Se3 pose = motion.correct(frame.time_s, result.solution);
  recovery.sharpen(pose * predicted.inverse());
  anchor = local.reference_keyframe;
  uncertainty.see(map.keyframe(anchor));
  remember_tracked(result);
  return result.solution.inliers < kFewInliers ? follow_walls(frame, pose) : pose;
}

/// A rover that knows no corner in view still sees the walls of where it has just been.
Se3 Slam::Impl::follow_walls(const CameraFrame& frame, const Se3& pose) {
  if (!motion.planar() || health.state() == TrackingState::kLost) return pose;
  const auto look = wall_ties.look(frame, map, anchor, pose, motion);
  return look ? motion.correct(*look) : pose;
}

/// What this frame says about the pose believed; a jump that is confirmed mends the poses before.
void Slam::Impl::judge(const CameraFrame& frame, bool tracked, const Se3& pose) {
  const ViewVerdict verdict =
      tracked ? ViewVerdict::kAgrees
              : view_verdict(map, local.landmarks, frame, pose, motion.planar());
  health.update({.time_s = frame.time_s,
                 .tracked = tracked,
                 .verdict = verdict,
                 .carried = motion.carried(),
                 .continuous = continuity.follows(frame, pose) && motion.planar()});
  recovery.mend(history);
}

void Slam::Impl::remember_tracked(const TrackResult& result) {
  tracked_landmarks.clear();
  for (const int l : result.visible) ++map.landmark(l).predicted;
  for (const FeatureMatch& m : result.matches) {
    ++map.landmark(m.landmark).tracked;
    tracked_landmarks.push_back(m.landmark);
  }
}

void Slam::Impl::insert_keyframe(const CameraFrame& frame, FeatureSet features,
                                 const TrackResult& result, const Se3& pose) {
  Keyframe k = make_keyframe(frame, std::move(features), result.matches, pose);
  if (motion.planar()) k.walls = wall_ties.scan(frame, map);
  const bool blind = result.status != TrackStatus::kTracked;
  uncertainty.join(k, motion.predict(frame.time_s).covariance, blind);
  const int id = map.add_keyframe(std::move(k));
  motion.mark_keyframe(id, frame.time_s);
  if (wall_ties.seen()) wall_ties.tie(map, id, anchor, motion);
  local.reference_keyframe = anchor = id;
  tracked_landmarks.clear();
  for (const int l : map.keyframe(id).landmark_of) {
    if (l >= 0) tracked_landmarks.push_back(l);
  }
  map.cull(local.landmarks);

  const MotionPrediction now = motion.predict(frame.time_s);
  const auto moved = back_end.add_newest(links(), {now.sigma_position_m, now.sigma_heading_rad});
  if (moved) {
    motion.shift(*moved);
    uncertainty.see(map.keyframe(id));
  }
  map.forget_unmatched(id);
  cull_keyframes();
}

/// What others show as well goes, so that the map grows with the space seen and not with the time
/// spent in it.
void Slam::Impl::cull_keyframes() {
  while (const auto culling = dispensable_keyframe(map)) {
    back_end.cull(*culling);
    rehang_links(map, *culling, motion.links());
    rehang_links(map, *culling, wall_ties.links());
    map.cull_keyframe(culling->keyframe, culling->host);
  }
}

/// Everything that ties keyframes but corners: wheels with gyro, and walls.
std::vector<MotionLink> Slam::Impl::links() const {
  std::vector<MotionLink> all = motion.links();
  all.insert(all.end(), wall_ties.links().begin(), wall_ties.links().end());
  return all;
}

void Slam::Impl::dead_reckon(double time_s) {
  if (!motion.planar() || time_s - history.last_time_s() < kDeadReckonedEveryS) return;
  remember_pose(time_s, motion.predict(time_s).prior.map_from_base, false);
}

void Slam::Impl::remember_pose(double time_s, const Se3& pose, bool is_camera_frame) {
  const Se3 relative = anchor < 0 ? pose : map.keyframe(anchor).map_from_base.inverse() * pose;
  history.add(time_s, anchor, relative, is_camera_frame);
}

PoseEstimate Slam::Impl::report(double time_s, const Se3& pose) {
  if (const auto guess = recovery.guess(); guess && guess->time_s >= time_s) return *guess;
  return report_pose(pose, time_s, motion.predict(time_s), uncertainty.at(pose), health.state(),
                     time_s - last_frame_s, config.localizer);
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
  s.recovery.add(observation);
  s.dead_reckon(time_s);
  const bool late = s.last_frame_s > 0.0 && time_s - s.last_frame_s >= kFrameIsLateS;
  if (!late || !s.motion.planar()) return std::nullopt;
  return s.report(time_s, s.motion.predict(time_s).prior.map_from_base);
}

maps::SavedMap Slam::finish() {
  Impl& s = *impl_;
  s.back_end.forget_places();
  s.back_end.adjust_everything(
      s.links(), s.motion.planar() ? wall_revisits(s.map) : std::vector<MotionLink>{});
  maps::SavedMap out;
  out.metadata.software_version = ROVIGO_VERSION;
  out.metadata.camera = s.rig.camera;
  out.metadata.base_from_camera = to_mrpt(s.base_from_camera);
  out.edges = store_edges(s.back_end.edges());
  out.trajectory = s.history.poses(s.map);
  out.grid = s.surroundings.render(s.map);
  out.keyframes = hand_over_keyframes(s.map);
  return out;
}

SlamSummary Slam::summary() const {
  SlamSummary out = impl_->counters;
  out.keyframes = impl_->map.living_keyframes();
  out.loop_closures = impl_->back_end.loop_closures();
  const FloorPlane& floor = impl_->surroundings.floor();
  out.floor_height_m = floor.height_m;
  out.floor_tilt_rad = std::atan(std::hypot(floor.slope_x, floor.slope_y));
  out.floor_looks = floor.looks;
  return out;
}

}  // namespace rovigo::slam
