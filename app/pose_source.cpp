#include "app/pose_source.h"

#include <cmath>
#include <deque>
#include <random>

#include "slam/grid_localizer.h"
#include "slam/localizer.h"

namespace rovigo::app {

namespace {

control::PoseQuality quality_of(slam::Health health) {
  switch (health) {
    case slam::Health::kOk:
      return control::PoseQuality::kGood;
    case slam::Health::kDegraded:
      return control::PoseQuality::kDoubtful;
    case slam::Health::kLost:
      break;
  }
  return control::PoseQuality::kLost;
}

/// What slam's two localisers share: they take observations and give estimates.
template <class AnyLocalizer>
class EstimatedPoses final : public PoseSource {
 public:
  template <class... Arguments>
  explicit EstimatedPoses(const Arguments&... arguments) : localizer_(arguments...) {}

  void observe(const mrpt::obs::CObservation& observation) override {
    // An estimator's past is done: what others have overtaken on its way comes too late for it.
    const double told_s = mrpt::Clock::toDouble(observation.timestamp);
    if (told_s < newest_s_) return;
    newest_s_ = told_s;
    const slam::PoseEstimate estimate = localizer_.process(observation);
    last_ = {estimate.time_s, TPose2D(estimate.map_from_base.asTPose()), estimate.sigma_position_m,
             quality_of(estimate.health)};
  }
  control::PoseInput pose(double /*now_s*/) override { return last_; }

 private:
  AnyLocalizer localizer_;
  double newest_s_ = 0.0;
  control::PoseInput last_;
};

class TruePoses final : public PoseSource {
 public:
  TruePoses(const sim::Simulator& simulator, const TPose2D& world_from_map)
      : simulator_(simulator), map_from_world_(maps::inverse(world_from_map)) {}

  void observe(const mrpt::obs::CObservation&) override {}
  control::PoseInput pose(double now_s) override {
    const TPose2D world_from_base(simulator_.truth().world_from_base.asTPose());
    return {now_s, maps::compose(map_from_world_, world_from_base), 0.0,
            control::PoseQuality::kGood};
  }

 private:
  const sim::Simulator& simulator_;
  TPose2D map_from_world_;
};

/// Samples the truth at a rate, adds noise, and delivers each sample late by latency plus jitter.
class PerturbedPoses final : public PoseSource {
 public:
  PerturbedPoses(const sim::Simulator& simulator, const TPose2D& world_from_map,
                 const sim::PoseNoise& noise, std::uint64_t seed)
      : truth_(simulator, world_from_map), noise_(noise), random_(seed) {}

  void observe(const mrpt::obs::CObservation&) override {}
  control::PoseInput pose(double now_s) override {
    constexpr double kRoundingS = 1e-9;
    // Called at every control step, so a sample falls due at the first step past its time.
    if (now_s + kRoundingS >= next_sample_s_) {
      const double period_s = 1.0 / noise_.rate_hz;
      if (now_s - next_sample_s_ > period_s) next_sample_s_ = now_s;  // nobody asked for a while
      next_sample_s_ += period_s;
      measure(now_s);
    }
    while (!in_flight_.empty() && in_flight_.front().arrives_s <= now_s + kRoundingS) {
      last_ = in_flight_.front().pose;
      in_flight_.pop_front();
    }
    return last_;
  }

 private:
  struct Sample {
    double arrives_s;
    control::PoseInput pose;
  };
  void measure(double now_s) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    control::PoseInput pose = truth_.pose(now_s);
    pose.map_from_base.x += noise_.sigma_position_m * normal(random_);
    pose.map_from_base.y += noise_.sigma_position_m * normal(random_);
    pose.map_from_base.phi =
        maps::wrap_angle(pose.map_from_base.phi + noise_.sigma_heading_rad * normal(random_));
    pose.sigma_position_m = noise_.sigma_position_m;
    const double age = noise_.latency_s + noise_.jitter_s * (2.0 * uniform(random_) - 1.0);
    const bool is_lost = uniform(random_) < noise_.drop_share;
    if (is_lost) return;
    double arrives = now_s + std::max(age, 0.0);
    if (!in_flight_.empty()) arrives = std::max(arrives, in_flight_.back().arrives_s);  // in order
    in_flight_.push_back({arrives, pose});
  }

  TruePoses truth_;
  sim::PoseNoise noise_;
  std::mt19937_64 random_;
  double next_sample_s_ = 0.0;
  std::deque<Sample> in_flight_;
  control::PoseInput last_;
};

}  // namespace

std::unique_ptr<PoseSource> slam_poses(const slam::SlamConfig& config, const slam::Rig& rig,
                                       const maps::SavedMap& map, const TPose2D& start) {
  return std::make_unique<EstimatedPoses<slam::Localizer>>(
      config, rig, map, std::optional<slam::PosePrior>(slam::PosePrior{.map_from_base = start}));
}

std::unique_ptr<PoseSource> true_poses(const sim::Simulator& simulator,
                                       const TPose2D& world_from_map) {
  return std::make_unique<TruePoses>(simulator, world_from_map);
}

std::unique_ptr<PoseSource> odometry_poses(const slam::SlamConfig& config, const slam::Rig& rig,
                                           const maps::OccupancyGrid& grid, const TPose2D& start) {
  // Nobody can look the start up in a bare grid: it is taken at its word, to a few centimetres.
  const slam::PosePrior prior{
      .map_from_base = start, .sigma_position_m = 0.05, .sigma_heading_rad = 0.03};
  return std::make_unique<EstimatedPoses<slam::GridLocalizer>>(config, rig, grid, prior);
}

std::unique_ptr<PoseSource> perturbed_poses(const sim::Simulator& simulator,
                                            const TPose2D& world_from_map,
                                            const sim::Scenario& scenario, std::uint64_t seed) {
  return std::make_unique<PerturbedPoses>(simulator, world_from_map, scenario.pose, seed);
}

}  // namespace rovigo::app
