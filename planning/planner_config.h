#pragma once
// Every setting of planning, with its unit, range and default.

#include <optional>
#include <string>

#include "maps/settings.h"

namespace rovigo::planning {

enum class PlannerKind {
  kAStar,       ///< soft-cost A* on the inflated grid
  kThetaStar,   ///< Theta*: the shortest way, straight lines in any direction, no soft costs
  kRrtConnect,  ///< OMPL RRTConnect in the plane: any path, fast
  kRrtStar,     ///< OMPL RRT* in the plane: shorter the more iterations it gets
  kBitStar,     ///< OMPL BIT* in the plane: batches of samples, best ways first
  kPrmStar,     ///< OMPL PRM* in the plane: a roadmap, the shortest way on it
};

/// `astar`, `thetastar`, `rrtconnect`, `rrtstar`, `bitstar`, `prmstar`.
const char* to_string(PlannerKind kind);
std::optional<PlannerKind> parse_planner_kind(const std::string& text);

struct AStarConfig {
  int connectivity = 8;           ///< 4 or 8 neighbours
  double soft_cost_weight = 1.0;  ///< a metre at the highest soft cost counts as 1 + this metres
  double heuristic_weight = 1.0;  ///< above 1: at most this factor from optimal
  void describe(maps::SettingsVisitor& v);
};

struct OmplConfig {
  int rrtconnect_iterations = 200000;
  int rrtstar_iterations = 10000;
  int bitstar_iterations = 20000;
  int prmstar_iterations = 3000;
  double step_m = 2.0;  ///< longest edge of the tree
  double goal_bias = 0.05;
  void describe(maps::SettingsVisitor& v);
};

struct SplineConfig {
  std::string mode = "safe";       ///< safe (keeps its clearance) or reference (SciPy's, blind)
  double smoothing_cells2 = 2.0;   ///< reference mode; negative: SciPy's default
  bool smooth = true;              ///< false: drive the shortened polyline, stop-turn-go
  double max_curvature_1_m = 5.5;  ///< tighter bends become turns in place; there a wheel stands
  double control_spacing_m = 0.1;  ///< between control points before refinement
  double sample_spacing_m = 0.02;  ///< of the points handed out
  void describe(maps::SettingsVisitor& v);
};

struct TimingConfig {
  double speed_fraction = 1.0;             ///< of the robot's highest speed and turn rate
  double acceleration_fraction = 0.8;      ///< of its highest accelerations
  double max_lateral_acceleration = 0.25;  ///< m/s^2, v^2 times curvature
  double turn_first_threshold_rad = 0.5236;
  double max_wheel_speed_m_s = 0.8;  ///< at the rim; the motors' no-load speed is 1.0
  double escape_speed_m_s = 0.15;
  double slow_within_m = 0.0;    ///< room beyond the radius below which speed falls; 0: never
  double slow_speed_m_s = 0.15;  ///< where there is no room to spare
  double sample_period_s = 0.02;
  void describe(maps::SettingsVisitor& v);
};

struct PlannerConfig {
  std::string planner = "astar";       ///< text form of PlannerKind
  std::string footprint = "circle";    ///< or rectangle, for sampling planners: see footprint.h
  double escape_max_distance_m = 1.0;  ///< how far a start in the band may be from free ground
  double drive_margin_m = 0.06;        ///< kept beyond robot_radius_m in drives: drive_planner.h
  AStarConfig astar;
  OmplConfig ompl;
  SplineConfig spline;
  TimingConfig timing;
  void describe(maps::SettingsVisitor& v);
};

/// Plans with the rover's rectangle instead of the circle it turns in?
bool plans_with_rectangle(const PlannerConfig& config);

/// Ranges plus what ranges cannot say. Throws maps::InputError naming every bad field.
void validate(const PlannerConfig& config);

}  // namespace rovigo::planning
