#include "slam/grid_localizer.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "slam/camera_frame.h"
#include "slam/camera_model.h"
#include "slam/grid_match.h"
#include "slam/imu_reading.h"
#include "slam/inertial_filter.h"
#include "slam/recording/images.h"
#include "slam/se3.h"

namespace rovigo::slam {

namespace {

constexpr double kMinInlierShare = 0.5;  // less of the scan on the map's walls: a different place
constexpr int kMinPoints = 20;
constexpr double kOkSigmaM = 0.10;
constexpr double kLostSigmaM = 0.30;
constexpr double kStaleS = 0.5;       // without an agreeing scan: doubtful
constexpr double kLookFloorM = 0.01;  // errors all scans share: the grid's own
constexpr double kLookFloorRad = 0.003;

}  // namespace

struct GridLocalizer::Impl {
  SlamConfig config;
  CameraModel camera;
  Se3 base_from_camera;
  SignedDistanceField field;
  InertialFilter motion;
  double last_agreement_s = 0.0;
  bool started = false;

  Impl(const SlamConfig& c, const Rig& rig, const maps::OccupancyGrid& grid, const PosePrior& prior)
      : config(c),
        camera(rig.camera),
        base_from_camera(from_mrpt(rig.base_from_camera)),
        field(grid),
        motion(c.dead_reckoning) {
    motion.place(prior.map_from_base, prior.sigma_position_m, prior.sigma_heading_rad);
  }

  void look(double time_s, const mrpt::obs::CObservation3DRangeScan& observation) {
    motion.advance_to(time_s);
    const GridMatch match =
        match_scan(field,
                   obstacle_points(depth_view(observation), observation.rangeUnits, camera,
                                   base_from_camera, config),
                   motion.map_from_base(), motion.pose_covariance());
    if (match.points < kMinPoints || match.inlier_share < kMinInlierShare) return;
    motion.correct(match.look, kLookFloorM, kLookFloorRad);
    last_agreement_s = time_s;
  }

  void take(const mrpt::obs::CObservation& observation) {
    const double time_s = time_of(observation);
    if (!started) {
      last_agreement_s = time_s;  // the start was given
      started = true;
    }
    if (const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation)) {
      look(time_s, *scan);
    } else if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation)) {
      const ImuReading reading = imu_in_base(*imu);
      if (reading.rate_rad_s) motion.add_gyro(time_s, *reading.rate_rad_s);
      if (reading.specific_force_m_s2) {
        motion.add_accelerometer(time_s, *reading.specific_force_m_s2);
      }
    } else if (const auto* wheels =
                   dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
      motion.add_wheels(time_s, wheels->odometry.asTPose());
    }
  }

  PoseEstimate estimate() const {
    const Eigen::Matrix3d covariance = motion.pose_covariance();
    const TPose2D pose = motion.map_from_base();
    PoseEstimate out;
    out.time_s = motion.time_s();
    out.map_from_base = mrpt::poses::CPose3D(mrpt::math::TPose3D(pose));
    out.sigma_position_m = std::sqrt(std::max(0.0, covariance(0, 0) + covariance(1, 1)));
    out.sigma_heading_rad = std::sqrt(std::max(0.0, covariance(2, 2)));
    const bool stale = motion.time_s() - last_agreement_s > kStaleS;
    if (out.sigma_position_m > kLostSigmaM) {
      out.health = Health::kLost;
    } else {
      out.health = stale || out.sigma_position_m > kOkSigmaM ? Health::kDegraded : Health::kOk;
    }
    // The chance that a Gaussian of this spread stays within the 0.20 m that make a pose right.
    const double ratio = 0.20 / std::max(1e-3, out.sigma_position_m);
    out.confidence = (stale ? 0.5 : 1.0) * (1.0 - std::exp(-0.5 * ratio * ratio));
    return out;
  }
};

GridLocalizer::GridLocalizer(const SlamConfig& config, const Rig& rig,
                             const maps::OccupancyGrid& grid, const PosePrior& prior)
    : impl_(std::make_unique<Impl>(config, rig, grid, prior)) {}

GridLocalizer::~GridLocalizer() = default;

PoseEstimate GridLocalizer::process(const mrpt::obs::CObservation& observation) {
  impl_->take(observation);
  return impl_->estimate();
}

}  // namespace rovigo::slam
