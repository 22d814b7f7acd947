#include "app/drive_recovery.h"

#include <algorithm>

#include "app/plan_query.h"
#include "planning/splice.h"

namespace rovigo::app {

DriveRecovery Replanner::recovery(double start_heading_rad) {
  return {start_heading_rad, [this](const TPose2D& map_from_base, const control::DriveLog& so_far) {
            return plan_anew(map_from_base, so_far);
          }};
}

std::unique_ptr<control::DriveController> Replanner::plan_anew(const TPose2D& map_from_base,
                                                               const control::DriveLog& so_far) {
  drop_passed_stops(so_far);
  request_.start = map_from_base;
  request_.start_heading_given = true;
  const planning::PlanResult plan = drive_planner_on(map_, config_).plan(request_);
  if (plan.status != planning::PlanStatus::kOk || plan.unsafe_samples > 0) return nullptr;
  planned_ = planning::joined(planned_, reached_s(so_far.steps.back().reference), plan.trajectory);
  return make_controller_(plan.trajectory);
}

/// Stops lie on the plan: the reference has been at those that are done.
void Replanner::drop_passed_stops(const control::DriveLog& so_far) {
  constexpr double kAtM = 0.05;
  auto step = so_far.steps.begin();
  while (!request_.via.empty()) {
    step = std::find_if(step, so_far.steps.end(), [&](const control::DriveStep& s) {
      return maps::distance(maps::position_of(s.reference.pose), request_.via.front()) < kAtM;
    });
    if (step == so_far.steps.end()) return;
    request_.via.erase(request_.via.begin());
  }
}

/// When the plan comes nearest to where the reference was last.
double Replanner::reached_s(const planning::TrajectoryPoint& reference) const {
  const auto away = [&](const planning::TrajectoryPoint& p) {
    return maps::distance(maps::position_of(p.pose), maps::position_of(reference.pose));
  };
  return std::min_element(planned_.points.begin(), planned_.points.end(),
                          [&](const auto& a, const auto& b) { return away(a) < away(b); })
      ->time_s;
}

}  // namespace rovigo::app
