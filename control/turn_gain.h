#pragma once
// How much of a commanded turn really happens: skid-steered wheels scrub, and floors differ.

#include <optional>

#include "control/pose_predictor.h"

namespace rovigo::control {

/// Least squares, with forgetting, of measured turns on asked turns. Starts at 1 and is bounded, so
/// that a few bad poses cannot take it far.
class TurnGainEstimator {
 public:
  static constexpr double kLowest = 0.6;
  static constexpr double kHighest = 1.15;

  /// A pose's yaw at its time; `predictor` knows what was asked since the previous one.
  void add(double time_s, double yaw_rad, const PosePredictor& predictor);
  /// The next pose starts a new comparison (after an outage or a jump).
  void interrupt() { start_.reset(); }
  double gain() const;

 private:
  struct Start {
    double time_s;
    double yaw_rad;
  };
  static constexpr double kWindowS = 0.25;        ///< long against pose noise, short against slip
  static constexpr double kLongestWindowS = 1.0;  ///< within the predictor's memory
  static constexpr double kLeastTurnRateRadS = 0.1;  ///< below it stiction rules, not scrubbing
  static constexpr double kPriorRad2 = 0.02;         ///< weight of "gain is 1"
  static constexpr double kMemoryRad = 3.0;          ///< turns are forgotten after as much again

  std::optional<Start> start_;
  double asked_asked_ = 0.0;
  double asked_measured_ = 0.0;
};

}  // namespace rovigo::control
