#pragma once
// Brings a rover to a stop at a wanted pose that a marker shows, heading included (mission F8).

#include "control/switching_pi.h"
#include "maps/geometry.h"

namespace rovigo::control {

struct DockingConfig {
  SwitchingPiConfig
      along{};  ///< from the distance left to the speed; its sample time is the loop's
  double approach_gain_1_m = 3.0;  ///< heading towards the axis per metre beside it
  double max_approach_angle_rad = 0.6;
  double heading_gain_1_s = 2.0;
  double max_turn_rate_rad_s = 0.8;
  double turn_first_angle_rad = 0.5;
  double along_tolerance_m = 0.008;
  double across_tolerance_m = 0.012;
  double heading_tolerance_rad = 0.012;
  double least_turn_rate_rad_s = 0.3;  ///< a standing rover turns at no less
  double back_up_m = 0.9;              ///< where it came in too far beside the axis
  double back_up_speed_m_s = 0.2;
  int most_attempts = 4;
};

enum class DockingStatus { kRunning, kDocked, kMissed };

struct DockingOutput {
  TTwist2D command;
  DockingStatus status = DockingStatus::kRunning;
};

/// The dock's frame: origin where base_link is to stop, x ahead, towards the marker. The rover is
/// to begin behind it (x below 0), facing it. Speed comes from the switching PI over the way left;
/// heading steers to the dock's axis. Standing there, it turns to the dock's heading; too far
/// beside the axis, which a differential drive cannot mend on the spot, it backs up and comes in
/// again.
class DockingController {
 public:
  explicit DockingController(const DockingConfig& config) : config_(config), along_(config.along) {}

  /// To be called once each sample time, with where the rover is.
  DockingOutput step(const TPose2D& dock_from_base);
  int attempts() const { return attempts_; }

 private:
  enum class Phase { kApproach, kAlign, kBackUp };
  TTwist2D approach(const TPose2D& at);
  TTwist2D align(const TPose2D& at);
  TTwist2D back_up(const TPose2D& at);
  double turn_rate(double heading_error) const;

  DockingConfig config_;
  SwitchingPi along_;
  Phase phase_ = Phase::kApproach;
  DockingStatus status_ = DockingStatus::kRunning;
  int attempts_ = 1;
};

}  // namespace rovigo::control
