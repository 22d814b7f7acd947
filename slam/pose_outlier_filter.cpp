#include "slam/pose_outlier_filter.h"

#include <algorithm>
#include <cmath>

#include "maps/geometry.h"

namespace rovigo::slam {

namespace {
constexpr std::size_t kHeading = 2;
}

PoseOutlierFilter::PoseOutlierFilter(const PoseOutlierFilterConfig& config) : config_(config) {
  config_.window = std::max<std::size_t>(2, config_.window);
  tau_.fill(config_.tau_max);
}

/// Tau falls while the window's spread is small, and is back at its largest when it is not.
void PoseOutlierFilter::settle(std::size_t axis) {
  const auto [low, high] =
      std::minmax_element(samples_.begin(), samples_.end(),
                          [&](const Pose& a, const Pose& b) { return a[axis] < b[axis]; });
  const bool settled = (*high)[axis] - (*low)[axis] < config_.settled_spread[axis];
  tau_[axis] =
      settled ? std::max(config_.tau_min[axis], tau_[axis] - config_.tau_step) : config_.tau_max;
}

PoseOutlierFilter::Pose PoseOutlierFilter::add(const Pose& sample) {
  const bool finite =
      std::all_of(sample.begin(), sample.end(), [](double v) { return std::isfinite(v); });
  if (finite) {
    Pose y = sample;
    if (samples_.empty()) {
      state_ = y;
    } else {
      // The turn since the last sample is the short way round.
      const double last = samples_.back()[kHeading];
      y[kHeading] = last + maps::wrap_angle(y[kHeading] - last);
    }
    samples_.push_back(y);
    if (samples_.size() > config_.window) samples_.pop_front();
    for (std::size_t axis = 0; axis < y.size(); ++axis) {
      settle(axis);
      state_[axis] = tau_[axis] * state_[axis] + (1.0 - tau_[axis]) * y[axis];
    }
  }
  return {state_[0], state_[1], maps::wrap_angle(state_[kHeading])};
}

}  // namespace rovigo::slam
