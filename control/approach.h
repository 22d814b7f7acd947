#pragma once
// A short way from where the rover ended up to where it should stand.

#include "control/command_limiter.h"
#include "planning/trajectory.h"

namespace rovigo::control {

/// Turn towards `to`, drive there straight, turn to its heading: at rest at both ends, slow
/// (at most `speed_m_s` and half the turn limits). The straight part is left out when `to` is
/// within `position_slack_m`, a turn when there is none to make. Never empty.
planning::Trajectory approach_trajectory(const TPose2D& from, const TPose2D& to, double speed_m_s,
                                         double position_slack_m, const DriveLimits& limits);

}  // namespace rovigo::control
