#pragma once
// How fast a wheel must be asked to turn before it starts to: learned from commands that moved
// nothing, because floors, loads and worn gears change it.

#include <optional>

#include "maps/geometry.h"

namespace rovigo::control {

/// Starts at what is known of the drive and only grows, a step for each stall that is noticed.
class StictionEstimator {
 public:
  static constexpr double kHighest = 0.12;  ///< rim speed, m/s

  StictionEstimator(double dead_zone_m_s, double track_width_m)
      : dead_zone_m_s_(dead_zone_m_s), half_track_m_(track_width_m / 2) {}

  /// Under `command` the drive's model, with this dead zone, moved by `modelled` for `dt_s`.
  void expect(const TTwist2D& command, const TTwist2D& modelled, double dt_s);
  /// A measured pose, `sigma_position_m` as it states it. True when it made the dead zone grow.
  bool pose(const TPose2D& map_from_base, double sigma_position_m);
  /// The next pose starts a new comparison (after an outage or a jump).
  void interrupt() { window_.reset(); }

  double dead_zone_m_s() const { return dead_zone_m_s_; }

 private:
  struct Window {
    TPose2D start;
    double seconds = 0.0;
    double forward_m = 0.0, turn_m = 0.0;  ///< expected, at the rim
  };
  bool stalled(const TPose2D& now, double sigma_position_m) const;
  bool tells(double sigma_position_m) const;

  double dead_zone_m_s_;
  double half_track_m_;
  std::optional<Window> window_;
};

}  // namespace rovigo::control
