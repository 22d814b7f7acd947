#pragma once
// What a drive does that lost its pose and found itself again: a new plan for the way that is left.

#include <functional>
#include <memory>

#include "app/config.h"
#include "app/simulated_drive.h"
#include "maps/map_file.h"
#include "planning/planner.h"

namespace rovigo::app {

/// Plans on the map as the drive was planned, from wherever the rover is. Map and config must
/// outlive it.
class Replanner {
 public:
  using MakeController =
      std::function<std::unique_ptr<control::DriveController>(const planning::Trajectory&)>;

  /// `planned`: what the drive follows so far, an answer to `request`; `make_controller`: what
  /// follows the rest.
  Replanner(const maps::SavedMap& map, const RovigoConfig& config, planning::PlanRequest request,
            planning::Trajectory planned, MakeController make_controller)
      : map_(map),
        config_(config),
        request_(std::move(request)),
        planned_(std::move(planned)),
        make_controller_(std::move(make_controller)) {}

  /// For DriveHooks; the replanner must outlive the drive.
  DriveRecovery recovery(double start_heading_rad);

  /// All that was followed, one way after the other: what the drive is measured against.
  const planning::Trajectory& planned() const { return planned_; }

 private:
  std::unique_ptr<control::DriveController> plan_anew(const TPose2D& map_from_base,
                                                      const control::DriveLog& so_far);
  void drop_passed_stops(const control::DriveLog& so_far);
  double reached_s(const planning::TrajectoryPoint& reference) const;

  const maps::SavedMap& map_;
  const RovigoConfig& config_;
  planning::PlanRequest request_;
  planning::Trajectory planned_;
  MakeController make_controller_;
};

}  // namespace rovigo::app
