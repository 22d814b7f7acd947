#include "planning/plan_status.h"

namespace rovigo::planning {

int refusal_code(PlanStatus status) {
  switch (status) {
    case PlanStatus::kOk:
      return 0;
    case PlanStatus::kStartOutsideMap:
      return 203;
    case PlanStatus::kGoalOutsideMap:
      return 204;
    case PlanStatus::kStartOccupied:
      return 205;
    case PlanStatus::kGoalOccupied:
      return 206;
    case PlanStatus::kTimeout:
      return 207;
    case PlanStatus::kNoPath:
      return 208;
  }
  return 208;
}

const char* to_string(PlanStatus status) {
  switch (status) {
    case PlanStatus::kOk:
      return "ok";
    case PlanStatus::kStartOutsideMap:
      return "start_outside_map";
    case PlanStatus::kGoalOutsideMap:
      return "goal_outside_map";
    case PlanStatus::kStartOccupied:
      return "start_occupied";
    case PlanStatus::kGoalOccupied:
      return "goal_occupied";
    case PlanStatus::kTimeout:
      return "timeout";
    case PlanStatus::kNoPath:
      return "no_path";
  }
  return "no_path";
}

}  // namespace rovigo::planning
