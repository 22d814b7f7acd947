#include "slam/slam.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>

#include "slam/bundle_adjustment.h"
#include "slam/camera_frame.h"
#include "slam/depth_scan.h"
#include "slam/features.h"
#include "slam/grid_mapper.h"
#include "slam/keyframe_codec.h"
#include "slam/landmark_map.h"
#include "slam/local_map.h"
#include "slam/loop_closer.h"
#include "slam/map_storage.h"
#include "slam/motion_model.h"
#include "slam/place_match.h"
#include "slam/tracker.h"
#include "slam/trajectory_history.h"

namespace rovigo::slam {

namespace {

constexpr double kDeadReckonedEveryS = 0.08;  // poses where frames are missing: above 10 Hz
constexpr int kMinFirstFeatures = 50;         // with depth, to start a map on
constexpr int kFinalIterations = 8;
constexpr double kScanSpacing = 0.15;  // in units of the keyframe spacing
constexpr double kBodyRadiusM = 0.20;  // half the rover's width: where it was is free

/// A scan held relative to a keyframe, so that the grid follows the optimised poses.
struct AnchoredScan {
  int keyframe = 0;
  Se3 keyframe_from_base;
  DepthScan scan;
};

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
        scanner(camera, settings.grid, settings.depth) {}

  void begin(double time_s);
  void dead_reckon(double time_s);
  PoseEstimate on_frame(const mrpt::obs::CObservation3DRangeScan& scan);
  TrackResult track(const FeatureSet& features, const MotionPrediction& prediction);
  void recover(const FeatureSet& features, TrackResult& result);
  void remember_tracked(const TrackResult& result);
  void insert_keyframe(const CameraFrame& frame, FeatureSet features, const TrackResult& result,
                       const Se3& pose);
  void look_for_loop(double time_s);
  void adjust_everything();
  void scan_surroundings(const CameraFrame& frame, const Se3& pose);
  maps::OccupancyGrid render() const;
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
  DepthScanner scanner;
  std::vector<AnchoredScan> scans;
  Se3 last_scan_pose;
  LocalMap local;
  std::vector<int> tracked_landmarks;
  SlamSummary counters;
  bool begun = false;
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

/// Keeps a flat scan of what the depth camera sees wherever the view has changed a little.
void Slam::Impl::scan_surroundings(const CameraFrame& frame, const Se3& pose) {
  if (!motion.planar() || frame.depth.empty() || local.reference_keyframe < 0) return;
  if (!scans.empty() && keyframe_spacing(last_scan_pose, pose, config.tracking) < kScanSpacing) {
    return;
  }
  last_scan_pose = pose;
  const Se3 keyframe_from_base =
      map.keyframe(local.reference_keyframe).map_from_base.inverse() * pose;
  scans.push_back({local.reference_keyframe, keyframe_from_base,
                   scanner.scan(frame.depth, frame.depth_unit_m, base_from_camera)});
}

maps::OccupancyGrid Slam::Impl::render() const {
  GridRequest request;
  for (const AnchoredScan& s : scans) {
    const Se3 pose = map.keyframe(s.keyframe).map_from_base * s.keyframe_from_base;
    request.scans.push_back({to_planar(pose), &s.scan});
  }
  if (motion.planar()) {
    for (const maps::StoredPose& p : history.poses(map)) {
      request.driven.push_back(to_planar(from_mrpt(p.map_from_base)));
    }
    request.driven_radius_m = kBodyRadiusM;
  }
  return render_grid(request, config.grid);
}

TrackResult Slam::Impl::track(const FeatureSet& features, const MotionPrediction& prediction) {
  if (map.keyframes().empty()) return {};
  local = select_local_map(map, tracked_landmarks, prediction.prior.map_from_base);
  TrackResult result = track_frame(map, local.landmarks, features, prediction);
  if (result.status != TrackStatus::kTracked) recover(features, result);
  return result;
}

/// Without a usable prediction: the last known surroundings, by appearance.
void Slam::Impl::recover(const FeatureSet& features, TrackResult& result) {
  const PlaceMatch found =
      match_place(map, local.landmarks, local.landmarks, features, motion.planar(),
                  {.min_inliers = 2 * config.tracking.min_inliers,
                   .seed = static_cast<std::uint64_t>(counters.camera_frames)});
  if (!found.accepted) return;
  result.status = TrackStatus::kTracked;
  result.solution = found.solution;
  result.matches = found.matches;
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

  const TrackResult result = track(features, prediction);
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
  scan_surroundings(frame, pose);
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
  out.grid = s.render();
  return out;
}

SlamSummary Slam::summary() const {
  SlamSummary out = impl_->counters;
  out.keyframes = static_cast<int>(impl_->map.keyframes().size());
  return out;
}

}  // namespace rovigo::slam
