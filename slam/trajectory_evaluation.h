#pragma once
// How well an estimated trajectory matches the true one (ATE and RPE of Sturm et al. 2012).

#include "slam/trajectory_file.h"

namespace rovigo::slam {

struct TrajectoryErrors {
  int associated = 0;       ///< pairs within 0.01 s
  double ate_rmse_m = 0.0;  ///< translation RMSE after SE(3) Umeyama alignment without scale
  double ate_max_m = 0.0;
  double rpe_translation_m = 0.0;  ///< RMSE over 1 s
  double rpe_rotation_rad = 0.0;
  double coverage = 0.0;          ///< share of the truth's time span with an estimate within 0.02 s
  double similarity_scale = 1.0;  ///< the scale a similarity alignment would choose
};

/// Throws InputError when fewer than three poses can be associated.
TrajectoryErrors evaluate_trajectory(const std::vector<StampedPose>& estimate,
                                     const std::vector<StampedPose>& truth);

}  // namespace rovigo::slam
