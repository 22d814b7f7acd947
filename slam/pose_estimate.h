#pragma once
// What slam says about where the rover is, and how far it may be trusted.

#include <mrpt/poses/CPose3D.h>

namespace rovigo::slam {

/// A pose is wrong beyond 0.20 m or 10 deg. kOk: right; kDegraded: dead-reckoned or doubtful;
/// kLost: not to be used.
enum class Health { kOk, kDegraded, kLost };

const char* to_string(Health health);

struct PoseEstimate {
  double time_s = 0.0;
  mrpt::poses::CPose3D map_from_base;
  double sigma_position_m = 0.0;  ///< 1-sigma of the horizontal position
  double sigma_heading_rad = 0.0;
  Health health = Health::kLost;
  double confidence = 0.0;  ///< 0 .. 1: the chance that the pose is right
};

}  // namespace rovigo::slam
