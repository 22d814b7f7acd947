#pragma once
// The pose outlier filter of mission F3: x+ = tau x + (1 - tau) y for each axis. The more settled
// the samples, the smaller tau and the less the filter lags; a jump brings full smoothing back.

#include <array>
#include <cstddef>
#include <deque>

namespace rovigo::slam {

struct PoseOutlierFilterConfig {
  double tau_max = 0.9;                              ///< after a jump: 0 copies, 1 never moves
  std::array<double, 3> tau_min = {0.1, 0.1, 0.08};  ///< x, y, heading, when settled
  double tau_step = 1.0 / 120.0;                     ///< by which tau falls with each sample
  std::array<double, 3> settled_spread = {0.5, 0.7, 0.2};  ///< m, m, rad: largest minus smallest
  std::size_t window = 20;  ///< samples whose spread is looked at; at least 2
};

/// For poses at a steady rate. It lags behind a moving rover by tau / (1 - tau) samples, so it is
/// meant for showing poses and for jumpy sources; the localizer's own poses are better unfiltered.
class PoseOutlierFilter {
 public:
  using Pose = std::array<double, 3>;  ///< x (m), y (m), heading (rad)

  explicit PoseOutlierFilter(const PoseOutlierFilterConfig& config = {});

  /// The filtered pose, heading in (-pi, pi]. The first sample is taken as it is; samples that are
  /// not finite change nothing (before the first finite one the zero pose is returned).
  Pose add(const Pose& sample);

  const Pose& tau() const { return tau_; }

 private:
  void settle(std::size_t axis);

  PoseOutlierFilterConfig config_;
  Pose state_{};  ///< heading not wrapped
  Pose tau_{};
  std::deque<Pose> samples_;  ///< the window, headings not wrapped
};

}  // namespace rovigo::slam
