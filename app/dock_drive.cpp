#include "app/dock_drive.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>

#include "slam/marker_detector.h"

namespace rovigo::app {

namespace {

constexpr double kNewSightingShare = 0.25;  // the rest is what the wheels made of the last ones
constexpr double kBlindForS = 1.0;

/// Where the rover is before the dock: sightings, carried on by the wheels.
class DockEstimate {
 public:
  void move(const TPose2D& odom_from_base) {
    if (last_odometry_ && pose_) {
      pose_ = maps::compose(*pose_, maps::compose(maps::inverse(*last_odometry_), odom_from_base));
    }
    last_odometry_ = odom_from_base;
  }
  void see(const TPose2D& seen, double time_s) {
    last_seen_s_ = time_s;
    if (!pose_) {
      pose_ = seen;
      return;
    }
    pose_->x += kNewSightingShare * (seen.x - pose_->x);
    pose_->y += kNewSightingShare * (seen.y - pose_->y);
    pose_->phi =
        maps::wrap_angle(pose_->phi + kNewSightingShare * maps::wrap_angle(seen.phi - pose_->phi));
  }
  /// Nothing where it has not been seen for too long.
  std::optional<TPose2D> pose(double now_s) const {
    return pose_ && now_s - last_seen_s_ <= kBlindForS ? pose_ : std::nullopt;
  }
  TPose2D last() const { return pose_.value_or(TPose2D()); }

 private:
  std::optional<TPose2D> pose_, last_odometry_;
  double last_seen_s_ = 0.0;
};

}  // namespace

TPose2D dock_from_sighting(const mrpt::poses::CPose3D& base_from_camera,
                           const mrpt::poses::CPose3D& camera_from_marker, double standoff_m) {
  const mrpt::poses::CPose3D base_from_marker = base_from_camera + camera_from_marker;
  const auto m = base_from_marker.getRotationMatrix();
  const double nx = m(0, 2), ny = m(1, 2);  // the marker's normal; the floor keeps it level
  const double level = std::max(std::hypot(nx, ny), 1e-9);
  const TPose2D base_from_dock(base_from_marker.x() + standoff_m * nx / level,
                               base_from_marker.y() + standoff_m * ny / level,
                               std::atan2(-ny, -nx));
  return maps::inverse(base_from_dock);
}

DockResult dock_on_marker(sim::Simulator& simulator, const DockRequest& request,
                          const control::DockingConfig& config) {
  control::DockingController controller(config);
  DockEstimate estimate;
  DockResult out;
  TTwist2D command;
  const double begin_s = simulator.time_s();
  double next_step_s = begin_s;
  const auto observe = [&](const mrpt::obs::CObservation& observation) {
    if (const auto* wheels = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
      estimate.move(TPose2D(wheels->odometry.asTPose()));
    }
    const auto* view = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation);
    if (!view || !view->hasIntensityImage) return;
    const sim::SensorRig& rig = simulator.rig();
    for (const auto& s :
         slam::find_markers(view->intensityImage.asCvMatRef(), rig.camera, request.marker_side_m)) {
      if (s.id != request.marker_id) continue;
      ++out.sightings;
      estimate.see(
          dock_from_sighting(rig.base_from_camera, s.camera_from_marker, request.standoff_m),
          simulator.time_s());
    }
  };
  while (out.status == control::DockingStatus::kRunning &&
         simulator.time_s() - begin_s < request.longest_s) {
    simulator.step(command);
    for (const auto& o : simulator.take_observations()) observe(*o);
    if (simulator.time_s() + 1e-9 < next_step_s) continue;
    next_step_s += config.along.sample_time_s;
    command = {};
    if (const auto at = estimate.pose(simulator.time_s())) {
      const control::DockingOutput step = controller.step(*at);
      command = step.command;
      out.status = step.status;
    }
  }
  for (int i = 0; i < 120; ++i) simulator.step({});  // until it stands
  out.seen = out.sightings > 0;
  out.attempts = controller.attempts();
  out.duration_s = simulator.time_s() - begin_s;
  out.dock_from_base = estimate.last();
  return out;
}

}  // namespace rovigo::app
