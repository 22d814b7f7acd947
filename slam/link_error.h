#pragma once
// Wheels and gyro in Ceres: links between keyframes, with the calibration as part of the unknowns.

#include <ceres/ceres.h>

#include <array>
#include <functional>
#include <vector>

#include "slam/ceres_pose.h"
#include "slam/motion_link.h"

namespace rovigo::slam {

/// Adds motion links to a problem (which must not own its loss functions) over keyframe steps. The
/// calibration drifts: one block for every ten seconds of the recording, tied to the next by how
/// far that time may move it.
class LinkErrors {
 public:
  using StepOf = std::function<double*(int keyframe)>;

  LinkErrors(const std::vector<MotionLink>& links, const DeadReckoningConfig& config);

  /// `poses`: what the steps step away from, by keyframe. The object must outlive the problem.
  void add_to(ceres::Problem& problem, const std::vector<Se3>& poses, const StepOf& step_of);

  std::vector<std::array<double, 4>>& calibrations() { return calibrations_; }

 private:
  std::size_t block_of(const MotionLink& link) const;
  void add_walks(ceres::Problem& problem);

  const std::vector<MotionLink>& links_;
  DeadReckoningConfig config_;
  ceres::CauchyLoss kernel_;
  double begin_s_ = 0.0;
  std::vector<std::array<double, 4>> calibrations_;
};

}  // namespace rovigo::slam
