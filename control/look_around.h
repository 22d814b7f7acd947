#pragma once
// A rover that does not know where it is finds itself by looking around.

#include <optional>

#include "control/drive_controller.h"

namespace rovigo::control {

/// Stands for a moment: a view may be recognised late. Then turns in place, at most once round,
/// until the pose is good, and back to `facing_rad` (map frame) where that is given. Ends with
/// kReached and a good pose, or with kPoseLost.
class LookAround final : public DriveController {
 public:
  explicit LookAround(std::optional<double> facing_rad = std::nullopt) : facing_rad_(facing_rad) {}

  TrackerOutput step(double now_s, const PoseInput& pose) override;
  TrackerOutput hold(double now_s) override;

 private:
  enum class Phase { kStand, kSearch, kFace };
  void enter(Phase phase, double now_s);
  std::optional<double> away_rad(const PoseInput& pose) const;

  std::optional<double> facing_rad_;
  Phase phase_ = Phase::kStand;
  std::optional<double> phase_since_s_;
  double held_since_s_ = -1.0;  ///< negative: not held
};

}  // namespace rovigo::control
