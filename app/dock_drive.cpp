#include "app/dock_drive.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>

#include "control/docking.h"
#include "slam/marker_detector.h"

namespace rovigo::app {

namespace {

constexpr double kBlindForS = 1.0;
constexpr double kSightingSigmaM = 0.01;

/// dock_from_base: the marker's place over the wheels' odometry, from all its sightings. Where it
/// is shows in each of them. Which way it faces hardly shows from afar, and a sighting may mean two
/// poses: a Kalman filter takes their mean, by how well each fits and stands upright, as being as
/// uncertain as they are apart. (To take the one that faces as believed locks in on a first error.)
class MarkerPoses final : public PoseSource {
 public:
  MarkerPoses(const sim::SensorRig& rig, int marker_id, const control::DockingConfig& dock)
      : rig_(rig), marker_id_(marker_id), dock_(dock) {}

  void observe(const mrpt::obs::CObservation& observation) override {
    time_s_ = mrpt::Clock::toDouble(observation.timestamp);
    if (const auto* wheels = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
      move(TPose2D(wheels->odometry.asTPose()));
    }
    const auto* view = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation);
    if (!view || !view->hasIntensityImage || !odom_from_base_) return;
    for (const auto& s :
         slam::find_markers(view->intensityImage.asCvMatRef(), rig_.camera, dock_.marker_side_m)) {
      if (s.id == marker_id_) see(s);
    }
  }
  control::PoseInput pose(double /*now_s*/) override {
    if (sightings_ == 0) return {time_s_, TPose2D(), 0.0, control::PoseQuality::kLost};
    const TPose2D odom_from_dock =
        maps::compose(odom_from_face_, {dock_.standoff_m, 0.0, maps::kPi});
    const bool blind = time_s_ - last_seen_s_ > kBlindForS;
    return {time_s_, maps::compose(maps::inverse(odom_from_dock), *odom_from_base_),
            kSightingSigmaM, blind ? control::PoseQuality::kLost : control::PoseQuality::kGood};
  }
  int sightings() const { return sightings_; }

 private:
  void move(const TPose2D& odom_from_base) {
    constexpr double kTurnError = 0.05;
    if (odom_from_base_) {
      const double turn = maps::wrap_angle(odom_from_base.phi - odom_from_base_->phi);
      yaw_variance_ += kTurnError * kTurnError * turn * turn;
    }
    odom_from_base_ = odom_from_base;
  }

  void see(const slam::MarkerSighting& sighting) {
    constexpr double kNewPlaceShare = 0.25, kCornerPx = 0.4, kDriftRad2 = 2e-5;  // a sighting
    const TPose2D one = face_of(sighting.camera_from_marker);
    const TPose2D other = face_of(sighting.other_camera_from_marker);
    const double distance = sighting.camera_from_marker.norm();
    // Perspective makes the far edge shorter: by so much less, the farther and smaller it is.
    const double sigma =
        std::max(0.005, kCornerPx * distance * distance /
                            (rig_.camera.fx() * dock_.marker_side_m * dock_.marker_side_m));
    const auto likelihood = [&](const mrpt::poses::CPose3D& pose, double rms_px) {
      const double lean = lean_of(pose) / (0.03 + sigma), misfit = 2.0 * rms_px / kCornerPx;
      return std::exp(-(lean * lean + misfit * misfit) / 2.0);
    };
    const double p_one = likelihood(sighting.camera_from_marker, sighting.reprojection_rms_px);
    const double p_other =
        likelihood(sighting.other_camera_from_marker, sighting.other_reprojection_rms_px);
    const double share = p_other / std::max(p_one + p_other, 1e-300);  // of the other pose
    const double apart = maps::wrap_angle(other.phi - one.phi);
    const double yaw = one.phi + share * apart;
    const double variance = sigma * sigma + share * (1.0 - share) * apart * apart;

    last_seen_s_ = time_s_;
    yaw_variance_ += kDriftRad2;
    const bool first = sightings_++ == 0;
    const double place_share = first ? 1.0 : kNewPlaceShare;
    const double yaw_share = first ? 1.0 : yaw_variance_ / (yaw_variance_ + variance);
    TPose2D& face = odom_from_face_;
    face = {face.x + place_share * (one.x - face.x), face.y + place_share * (one.y - face.y),
            maps::wrap_angle(face.phi + yaw_share * maps::wrap_angle(yaw - face.phi))};
    yaw_variance_ = first ? variance : (1.0 - yaw_share) * yaw_variance_;
  }

  TPose2D face_of(const mrpt::poses::CPose3D& camera_from_marker) const {
    return maps::compose(*odom_from_base_,
                         face_from_sighting(rig_.base_from_camera, camera_from_marker));
  }
  /// How far its face is from upright, radians.
  double lean_of(const mrpt::poses::CPose3D& camera_from_marker) const {
    const auto m = (rig_.base_from_camera + camera_from_marker).getRotationMatrix();
    return std::asin(std::clamp(m(2, 2), -1.0, 1.0));
  }

  sim::SensorRig rig_;
  int marker_id_;
  control::DockingConfig dock_;
  double time_s_ = 0.0;
  std::optional<TPose2D> odom_from_base_;
  TPose2D odom_from_face_;
  double yaw_variance_ = 0.0;
  double last_seen_s_ = 0.0;
  int sightings_ = 0;
};

}  // namespace

TPose2D face_from_sighting(const mrpt::poses::CPose3D& base_from_camera,
                           const mrpt::poses::CPose3D& camera_from_marker) {
  const mrpt::poses::CPose3D base_from_marker = base_from_camera + camera_from_marker;
  const auto m = base_from_marker.getRotationMatrix();
  return {base_from_marker.x(), base_from_marker.y(), std::atan2(m(1, 2), m(0, 2))};
}

DockDrive dock_on_marker(sim::Simulator& simulator, const TPose2D& world_from_dock, int marker_id,
                         const RovigoConfig& config, const DriveHooks& hooks) {
  MarkerPoses poses(simulator.rig(), marker_id, config.docking);
  control::DockingController controller(config.docking, config.control, config.robot);
  DockDrive out;
  out.log = drive_in_simulator(simulator, world_from_dock, poses, controller, 0.0, config, hooks);
  out.sightings = poses.sightings();
  out.attempts = controller.attempts();
  return out;
}

}  // namespace rovigo::app
