#pragma once
// Why a plan exists or does not, with the codes Nav2 uses.

namespace rovigo::planning {

enum class PlanStatus {
  kOk,
  kStartOutsideMap,
  kGoalOutsideMap,
  kStartOccupied,
  kGoalOccupied,
  kTimeout,  ///< a sampling planner used up its iterations although a way exists
  kNoPath,
};

/// Nav2's codes 203 .. 208; 0 for kOk.
int refusal_code(PlanStatus status);

/// `ok`, `start_outside_map`, `goal_outside_map`, `start_occupied`, `goal_occupied`, `timeout`,
/// `no_path`.
const char* to_string(PlanStatus status);

}  // namespace rovigo::planning
