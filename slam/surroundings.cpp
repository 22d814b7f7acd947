#include "slam/surroundings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "slam/grid_mapper.h"
#include "slam/keyframe_codec.h"
#include "slam/keyframe_scans.h"
#include "slam/local_map.h"

namespace rovigo::slam {

namespace {

constexpr double kLookSpacing = 0.15;   // in units of the keyframe spacing
constexpr double kRestSpacing = 0.005;  // 2 mm or 1 mrad: noise of a pose at rest
constexpr int kSettledFrames = 10;
constexpr double kBodyRadiusM = 0.20;  // half the rover's width: where it was is free
constexpr double kPatchRadiusM = 0.75;
constexpr int kMinShared = 20;  // landmarks, for keyframes to hang together rigidly
constexpr int kFloorLooks = 5;  // teach the floor's place well enough to start with
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// The frame of a patch: the map's axes as they are now, from a corner of a cell, so that patches
/// nothing has moved since lie on the map's cells exactly.
TPose2D frame_at(const Se3& map_from_base, double resolution_m) {
  const auto snap = [&](double v) { return std::round(v / resolution_m) * resolution_m; };
  return {snap(map_from_base.translation.x()), snap(map_from_base.translation.y()), 0.0};
}

}  // namespace

Surroundings::Surroundings(const SlamConfig& config, const CameraModel& camera,
                           const Se3& base_from_camera, bool on_floor)
    : config_(config),
      camera_(camera),
      base_from_camera_(base_from_camera),
      on_floor_(on_floor),
      filter_(config.depth_filter),
      scanner_(camera, config.depth),
      voter_(config.grid, config.depth),
      watch_(camera, config.depth) {}

/// The patch of a keyframe close by that is tied to this one by what both see; or the one in use.
std::size_t Surroundings::nearby_patch(const LandmarkMap& map, int keyframe) const {
  const Se3& here = map.keyframe(keyframe).map_from_base;
  const auto distance_to = [&](std::size_t i) {
    return (map.keyframe(patches_[i].keyframe).map_from_base.translation - here.translation).norm();
  };
  std::vector<int> tied;
  if (last_keyframe_ >= 0) tied.push_back(last_keyframe_);
  for (const auto& [id, shared] : map.covisible(keyframe, kMinShared)) tied.push_back(id);
  std::size_t best = kNone;
  for (const int id : tied) {
    const auto found = patch_of_keyframe_.find(id);
    if (found == patch_of_keyframe_.end()) continue;
    if (distance_to(found->second) > kPatchRadiusM) continue;
    if (best == kNone || distance_to(found->second) < distance_to(best)) best = found->second;
  }
  return best;
}

std::size_t Surroundings::patch_of(const LandmarkMap& map, int keyframe) {
  const auto known = patch_of_keyframe_.find(keyframe);
  if (known != patch_of_keyframe_.end()) return known->second;
  std::size_t patch = nearby_patch(map, keyframe);
  if (patch == kNone) {
    patch = patches_.size();
    const Se3& map_from_keyframe = map.keyframe(keyframe).map_from_base;
    patches_.push_back({keyframe,
                        maps::compose(maps::inverse(to_planar(map_from_keyframe)),
                                      frame_at(map_from_keyframe, config_.grid.grid_resolution_m)),
                        {}});
  }
  patch_of_keyframe_[keyframe] = patch;
  return patch;
}

/// Heights count from the floor that the camera sees.
void Surroundings::follow_floor(const DepthScanner::Samples& samples, double depth_unit_m) {
  floor_.update(scanner_.scan(samples, depth_unit_m, floor_.corrected(base_from_camera_)));
}

std::optional<FloorDepth> Surroundings::floor_under(const CameraFrame& frame) {
  if (!on_floor_ || frame.depth.empty()) return std::nullopt;
  if (floor_.plane().looks < kFloorLooks) {
    follow_floor(scanner_.sample(frame.depth), frame.depth_unit_m);
  }
  return FloorDepth(frame, camera_, config_.depth, floor_.corrected(base_from_camera_),
                    floor_.plane());
}

void Surroundings::look(const CameraFrame& frame, const LandmarkMap& map, int keyframe,
                        const Se3& pose) {
  if (!on_floor_ || frame.depth.empty() || keyframe < 0) return;
  AnchoredView view{
      frame.time_s, keyframe,
      from_planar(maps::compose(maps::inverse(to_planar(map.keyframe(keyframe).map_from_base)),
                                to_planar(pose))),
      floor_.corrected(base_from_camera_)};
  watch_.remember(frame.depth, frame.depth_unit_m, view);
  const bool at_rest = keyframe_spacing(frame_pose_, pose, config_.tracking) < kRestSpacing;
  frame_pose_ = pose;
  rested_frames_ = at_rest ? rested_frames_ + 1 : 0;
  const cv::Mat depth = filter_.apply(frame.depth, at_rest);
  const bool moved =
      last_keyframe_ < 0 || keyframe_spacing(last_pose_, pose, config_.tracking) >= kLookSpacing;
  // What is averaged over time is worth one more look, once the average has settled.
  const bool settled =
      config_.depth_filter.depth_temporal_filter && rested_frames_ == kSettledFrames;
  if (moved || settled) {
    const std::size_t patch = patch_of(map, keyframe);
    last_pose_ = pose;
    last_keyframe_ = keyframe;
    const AnchoredPatch& p = patches_[patch];
    const TPose2D map_from_patch =
        maps::compose(to_planar(map.keyframe(p.keyframe).map_from_base), p.keyframe_from_patch);
    const TPose2D patch_from_level = maps::compose(maps::inverse(map_from_patch), to_planar(pose));
    DepthScanner::Samples samples = scanner_.sample(depth);
    follow_floor(samples, frame.depth_unit_m);
    view.level_from_camera = floor_.corrected(base_from_camera_);
    pending_.push_back({view, patch, patch_from_level, std::move(samples), frame.depth_unit_m});
  }
  cast_votes_until(frame.time_s - MotionWatch::kHorizonS, map);
}

void Surroundings::cast_votes_until(double time_s, const LandmarkMap& map) {
  while (!pending_.empty() && pending_.front().view.time_s <= time_s) {
    PendingLook& look = pending_.front();
    EvidencePatch& evidence = patches_[look.patch].evidence;
    DepthScan scan = scanner_.scan(look.samples, look.depth_unit_m, look.view.level_from_camera);
    watch_.mark_moving(look.view, map, scan);
    voter_.vote(scan, look.patch_from_level, evidence);
    voter_.vote_driven(maps::position_of(look.patch_from_level), kBodyRadiusM, evidence);
    pending_.pop_front();
  }
}

/// For a camera that nobody knows the height of: evidence from the stored keyframes, one patch
/// each.
void Surroundings::add_keyframes(const LandmarkMap& map) {
  patches_.clear();
  for (const LevelView& view : level_views(map)) {
    const Keyframe& k = map.keyframe(view.keyframe);
    const TPose2D map_from_patch = frame_at(k.map_from_base, config_.grid.grid_resolution_m);
    const TPose2D map_from_level = to_planar(k.map_from_base);
    patches_.push_back({k.id, maps::compose(maps::inverse(map_from_level), map_from_patch), {}});
    const cv::Mat depth = decode_depth(k.depth_png, {map.camera().width(), map.camera().height()});
    voter_.vote(scanner_.scan(depth, kStoredDepthUnitM, view.level_from_camera),
                maps::compose(maps::inverse(map_from_patch), map_from_level),
                patches_.back().evidence);
  }
}

maps::OccupancyGrid Surroundings::render(const LandmarkMap& map) {
  if (!on_floor_) add_keyframes(map);
  cast_votes_until(std::numeric_limits<double>::infinity(), map);
  return grid_so_far(map);
}

maps::OccupancyGrid Surroundings::grid_so_far(const LandmarkMap& map) const {
  std::vector<PlacedPatch> placed;
  for (const AnchoredPatch& p : patches_) {
    placed.push_back(
        {maps::compose(to_planar(map.keyframe(p.keyframe).map_from_base), p.keyframe_from_patch),
         &p.evidence});
  }
  return render_grid(placed, config_.grid);
}

std::size_t Surroundings::memory_bytes() const {
  std::size_t sum = watch_.memory_bytes();
  for (const PendingLook& p : pending_) sum += p.samples.depths.size() * sizeof(std::uint16_t);
  for (const AnchoredPatch& p : patches_) sum += p.evidence.memory_bytes();
  return sum;
}

}  // namespace rovigo::slam
