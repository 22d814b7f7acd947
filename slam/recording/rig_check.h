#pragma once
// Whether a recording's calibration fits what its first seconds show.

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "slam/recording/registration_check.h"
#include "slam/rig.h"

namespace rovigo::slam {

/// One sentence when the intrinsics cannot be those of images of this size; else empty.
std::string intrinsics_warning(const mrpt::img::TCamera& camera);

/// Looks at the first frames and IMU samples and says what a person would want to know before he
/// trusts a map of them. It only warns: what cannot work at all is refused by the readers.
class RigCheck {
 public:
  explicit RigCheck(const Rig& rig);

  /// Free of cost once enough was seen (ten seconds).
  void add(const mrpt::obs::CObservation& observation);

  /// Sentences for the user; empty when all is well or nothing can be said.
  std::vector<std::string> warnings() const;

 private:
  void add_frame(const mrpt::obs::CObservation3DRangeScan& scan);
  void add_imu(const mrpt::obs::CObservationIMU& imu);
  void look_at_floor(const mrpt::obs::CObservation3DRangeScan& scan);
  std::string depth_scale_warning() const;
  std::string gravity_warning() const;

  Rig rig_;
  std::optional<double> first_s_;
  double next_frame_s_ = 0.0;
  bool is_over_ = false;
  RegistrationCheck registration_;
  std::vector<double> floor_heights_m_;  ///< by depth and extrinsics, a frame each
  std::vector<double> median_depths_m_;
  std::vector<double> near_depths_m_;  ///< 95th percentiles

  // The run of IMU samples at rest that is being watched, and the longest one so far.
  struct Rest {
    double begin_s = 0.0;
    double end_s = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    int samples = 0;
    double length_s() const { return end_s - begin_s; }
  };
  Rest rest_;
  Rest longest_rest_;
};

}  // namespace rovigo::slam
