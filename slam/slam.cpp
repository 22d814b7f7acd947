#include "slam/slam.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>

#include "slam/bundle_adjustment.h"
#include "slam/camera_frame.h"
#include "slam/features.h"
#include "slam/keyframe_codec.h"
#include "slam/landmark_map.h"
#include "slam/local_map.h"
#include "slam/loop_closer.h"
#include "slam/map_storage.h"
#include "slam/motion_model.h"
#include "slam/place_match.h"
#include "slam/surroundings.h"
#include "slam/tracker.h"
#include "slam/trajectory_history.h"

namespace rovigo::slam {

namespace {

// Between frames the trajectory holds dead-reckoned poses, so that no moment is farther than 0.02 s
// from one at any frame rate the wheels outpace.
constexpr double kDeadReckonedEveryS = 0.02;
constexpr int kMinFirstFeatures = 50;      // with depth, to start a map on
constexpr int kSearchEverywhereEvery = 5;  // frames without a match
constexpr double kFoundSigmaM = 0.05;      // of a pose found by recognising the place
constexpr double kFoundSigmaRad = 0.03;
constexpr double kSurprisingM = 0.15;
constexpr int kFinalIterations = 8;

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
  TrackResult track(double time_s, const FeatureSet& features, const MotionPrediction& prediction);
  void recover(double time_s, const FeatureSet& features, TrackResult& result);
  void remember_tracked(const TrackResult& result);
  void insert_keyframe(const CameraFrame& frame, FeatureSet features, const TrackResult& result,
                       const Se3& pose);
  void look_for_loop(double time_s);
  void adjust_everything();
  void remember_pose(double time_s, const Se3& pose, bool is_camera_frame);
  PoseEstimate estimate(double time_s, const Se3& pose, bool tracked);

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
  std::vector<int> tracked_landmarks;
  SlamSummary counters;
  bool begun = false;
  int misses = 0;  ///< frames in a row that matched nothing
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
  const int k = local.reference_keyframe;
  const Se3 relative = k < 0 ? pose : map.keyframe(k).map_from_base.inverse() * pose;
  history.add(time_s, k, relative, is_camera_frame);
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
  if (!found.accepted && misses % kSearchEverywhereEvery == 0) {
    found = loops.relocalizer()
                .find(map, features, motion.planar(), std::nullopt, {},
                      {.min_inliers = config.localizer.relocalization_inliers, .seed = seed})
                .match;
  }
  if (!found.accepted) return;
  result.status = TrackStatus::kTracked;
  result.solution = found.solution;
  result.matches = found.matches;
  // Far from what was believed, the prediction was worth nothing: carried, or lost for long.
  const MotionPrediction believed = motion.predict(time_s);
  const Se3& seen = found.solution.map_from_base;
  const double apart = (believed.prior.map_from_base.translation - seen.translation).norm();
  if (apart > kSurprisingM + 4.0 * believed.sigma_position_m) {
    motion.place(time_s, seen, kFoundSigmaM, kFoundSigmaRad);
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
  const int id = map.add_keyframe(std::move(k));
  local.reference_keyframe = id;
  tracked_landmarks.clear();
  for (const int l : map.keyframe(id).landmark_of) {
    if (l >= 0) tracked_landmarks.push_back(l);
  }
  map.cull(local.landmarks);
  for (const PoseGraphEdge& e : tracked_edges(map, id, motion.planar())) edges.push_back(e);
  look_for_loop(frame.time_s);
}

void Slam::Impl::look_for_loop(double time_s) {
  const MotionPrediction now = motion.predict(time_s);
  const int newest = static_cast<int>(map.keyframes().size()) - 1;
  const auto loop = loops.detect(map, {now.sigma_position_m, now.sigma_heading_rad});
  if (!loop || !config.loop.loop_closure) return;
  const Se3 before = map.keyframe(newest).map_from_base;
  if (!close_loop(map, edges, *loop)) return;
  ++counters.loop_closures;
  motion.shift(map.keyframe(newest).map_from_base * before.inverse());
}

/// The last word on all poses: everything seen, all at once.
void Slam::Impl::adjust_everything() {
  constexpr int kPasses = 2;  // the second without the sightings the first found wanting
  for (int pass = 0; pass < kPasses; ++pass) {
    adjust_bundle(map, {}, {}, {.iterations = kFinalIterations, .on_floor = motion.planar()});
  }
}

PoseEstimate Slam::Impl::estimate(double time_s, const Se3& pose, bool tracked) {
  const MotionPrediction now = motion.predict(time_s);
  PoseEstimate e;
  e.time_s = time_s;
  e.map_from_base = to_mrpt(pose);
  e.sigma_position_m = now.sigma_position_m;
  e.sigma_heading_rad = now.sigma_heading_rad;
  const bool bounded = now.sigma_position_m < config.localizer.lost_sigma_m;
  e.health = tracked ? Health::kOk : bounded ? Health::kDegraded : Health::kLost;
  e.confidence = tracked ? 0.95 : bounded ? 0.6 : 0.0;
  return e;
}

PoseEstimate Slam::Impl::on_frame(const mrpt::obs::CObservation3DRangeScan& scan) {
  const CameraFrame frame = camera_frame_from(scan, camera);
  const MotionPrediction prediction = motion.predict(frame.time_s);
  FeatureSet features;
  if (!frame.gray.empty())
    features = extract_features(frame, camera, config.features, config.depth);

  const TrackResult result = track(frame.time_s, features, prediction);
  const bool tracked = result.status == TrackStatus::kTracked;
  Se3 pose = prediction.prior.map_from_base;
  if (tracked) {
    pose = motion.correct(frame.time_s, result.solution);
    remember_tracked(result);
  } else {
    motion.miss(frame.time_s);
    tracked_landmarks.clear();
  }
  const auto with_depth = std::count_if(features.features().begin(), features.features().end(),
                                        [](const Feature& f) { return f.depth_m > 0; });
  const bool first = map.keyframes().empty() && with_depth >= kMinFirstFeatures;
  if (first || (tracked && wants_keyframe(map, local, result, features, pose))) {
    insert_keyframe(frame, std::move(features), result, pose);
    pose = map.keyframe(local.reference_keyframe).map_from_base;  // a loop may have moved it
  }
  remember_pose(frame.time_s, pose, true);
  surroundings.look(frame, map, local.reference_keyframe, pose);
  ++counters.camera_frames;
  counters.tracked_frames += tracked || first;
  return estimate(frame.time_s, pose, tracked || first);
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
  return std::nullopt;
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
  out.grid = s.surroundings.render(s.map, s.history);
  return out;
}

SlamSummary Slam::summary() const {
  SlamSummary out = impl_->counters;
  out.keyframes = static_cast<int>(impl_->map.keyframes().size());
  return out;
}

}  // namespace rovigo::slam
