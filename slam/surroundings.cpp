#include "slam/surroundings.h"

#include "slam/grid_mapper.h"
#include "slam/keyframe_scans.h"
#include "slam/local_map.h"

namespace rovigo::slam {

namespace {

constexpr double kScanSpacing = 0.15;  // in units of the keyframe spacing
constexpr double kBodyRadiusM = 0.20;  // half the rover's width: where it was is free

}  // namespace

Surroundings::Surroundings(const SlamConfig& config, const CameraModel& camera,
                           const Se3& base_from_camera, bool on_floor)
    : config_(config),
      base_from_camera_(base_from_camera),
      on_floor_(on_floor),
      scanner_(camera, config.grid, config.depth) {}

void Surroundings::look(const CameraFrame& frame, const LandmarkMap& map, int keyframe,
                        const Se3& pose) {
  if (!on_floor_ || frame.depth.empty() || keyframe < 0) return;
  const bool moved =
      scans_.empty() || keyframe_spacing(last_pose_, pose, config_.tracking) >= kScanSpacing;
  if (!moved) return;
  last_pose_ = pose;
  scans_.push_back({keyframe, map.keyframe(keyframe).map_from_base.inverse() * pose,
                    scanner_.scan(frame.depth, frame.depth_unit_m, base_from_camera_)});
}

maps::OccupancyGrid Surroundings::render(const LandmarkMap& map, const TrajectoryHistory& history) {
  GridRequest request;
  for (const AnchoredScan& s : scans_) {
    const Se3 pose = map.keyframe(s.keyframe).map_from_base * s.keyframe_from_base;
    request.scans.push_back({to_planar(pose), &s.scan});
  }
  std::vector<KeyframeScan> of_keyframes;
  if (on_floor_) {
    for (const maps::StoredPose& p : history.poses(map)) {
      request.driven.push_back(to_planar(from_mrpt(p.map_from_base)));
    }
    request.driven_radius_m = kBodyRadiusM;
  } else {
    of_keyframes = scans_of_keyframes(map, scanner_);
    for (const KeyframeScan& s : of_keyframes) {
      request.scans.push_back({s.map_from_level, &s.scan});
    }
  }
  return render_grid(request, config_.grid);
}

}  // namespace rovigo::slam
