#pragma once
// One query through all stages: settle the ends, search, straighten, smooth, time, measure.

#include <optional>
#include <string>
#include <vector>

#include "planning/any_angle_search.h"
#include "planning/astar.h"
#include "planning/footprint.h"
#include "planning/free_space.h"
#include "planning/planner.h"
#include "planning/smoother.h"

namespace rovigo::planning {

/// Path points this near to each other are one.
inline constexpr double kSamePointM = 1e-6;

/// What all queries on one map share; prepared once by Planner, not changed afterwards.
struct PlanningContext {
  maps::OccupancyGrid grid;
  maps::RobotModel robot;
  maps::InflationConfig inflation;
  PlannerConfig config;
  PlannerKind kind;
  maps::Costmap costmap;
  SearchGrid search_grid;
  FreeSpace space;
  /// Where the rectangle counts; `inflation` then has its inscribed radius.
  std::optional<FootprintSpace> footprint;

  /// Throws maps::InputError for settings out of range. `ready`: this costmap, not the grid
  /// inflated.
  PlanningContext(const maps::OccupancyGrid& grid, const maps::RobotModel& robot,
                  const maps::InflationConfig& inflation, const PlannerConfig& config,
                  const maps::Costmap* ready = nullptr);
  PlanningContext(const PlanningContext&) = delete;  // `space` refers to its neighbours
  PlanningContext& operator=(const PlanningContext&) = delete;
};

/// Memory that one query at a time works in.
struct SearchWorkspace {
  GridSearch search;
  AnyAngleSearch any_angle;
};

class PlanQuery {
 public:
  PlanQuery(const PlanningContext& context, SearchWorkspace& workspace, const PlanRequest& request)
      : context_(context),
        search_(workspace.search),
        any_angle_(workspace.any_angle),
        request_(request) {}

  PlanResult run();

 private:
  bool settle_start();
  bool settle_targets();
  bool order_targets();
  bool search_legs();
  bool search_leg(const TPoint2D& from, const TPoint2D& to, const std::string& name);
  GridSearchResult find_way(const SearchGrid& cells, maps::Cell from, maps::Cell to);
  bool sample_leg(const TPoint2D& from, const TPoint2D& to, const std::string& name, Path& leg);
  bool footprint_leg(const std::string& name, Path& leg);
  bool fits(const TPoint2D& at, std::optional<double> heading_rad) const;
  bool refuse_unfound(const TPoint2D& to, const std::string& name);
  void smooth_path();
  void straight_path();
  bool footprint_is_safe();
  void reference_path();
  void time_path();
  void measure();
  void report_cuts();

  void begin(PlanStage stage) const;
  bool refuse(PlanStatus status, const TPoint2D& point, std::string message);
  bool refuse_goal(PlanStatus status, const TPoint2D& point, std::string message);
  std::string why_not_free(const TPoint2D& point) const;
  std::string map_extent() const;
  std::string name_of_target(std::size_t index) const;
  std::vector<PathPiece> escape_pieces() const;
  bool is_reference() const;
  bool is_safe(const std::vector<PathPiece>& pieces, const Trajectory& trajectory) const;
  void time_pieces(const std::vector<PathPiece>& pieces);

  const PlanningContext& context_;
  GridSearch& search_;
  AnyAngleSearch& any_angle_;
  const PlanRequest& request_;

  PlanResult result_;
  std::vector<TPoint2D> escape_;   ///< from the start given to start_, when they differ
  TPoint2D start_;                 ///< where free driving begins
  std::vector<TPoint2D> targets_;  ///< via points and goal, each free
  std::optional<double> heading_;  ///< rectangle only: where the leg before ended
  SmoothingProblem problem_;
  std::vector<PathPiece> pieces_;
};

}  // namespace rovigo::planning
