#pragma once
// What every mission must show, whatever the faults.

#include <gtest/gtest.h>

#include "control/path_follower.h"
#include "control/tracking_metrics.h"
#include "tests/unit/control/simulated_drive.h"

namespace rovigo::control::testing {

/// Reached within 5 cm, without a collision, never backwards, never farther from the path than the
/// margin a planner keeps, and without dithering at the goal.
inline void expect_mission_done(std::uint64_t seed) {
  const Mission mission = random_mission(seed);
  const DriveLog log = drive_in_hall(mission.plan, mission.setup);
  const DriveMetrics m = measure(log, mission.plan, mission.plan.points.back().pose, true);
  EXPECT_EQ(log.status, TrackStatus::kReached) << "seed " << seed;
  EXPECT_EQ(log.contact_events, 0) << "seed " << seed;
  EXPECT_LE(m.final_position_error_m, 0.06) << "seed " << seed;
  EXPECT_LE(m.cross_track_max_m, 0.15) << "seed " << seed;
  for (const DriveStep& s : log.steps)
    ASSERT_GE(s.command.vx, -kTurnBackSpeedMS) << "seed " << seed;
  EXPECT_LE(m.goal_reversals, 6) << "seed " << seed;
}

}  // namespace rovigo::control::testing
