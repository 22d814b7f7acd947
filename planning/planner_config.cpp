#include "planning/planner_config.h"

#include "maps/error.h"

namespace rovigo::planning {

const char* to_string(PlannerKind kind) {
  switch (kind) {
    case PlannerKind::kAStar:
      return "astar";
    case PlannerKind::kThetaStar:
      return "thetastar";
    case PlannerKind::kRrtConnect:
      return "rrtconnect";
    case PlannerKind::kRrtStar:
      return "rrtstar";
    case PlannerKind::kBitStar:
      return "bitstar";
    case PlannerKind::kPrmStar:
      return "prmstar";
  }
  return "astar";
}

std::optional<PlannerKind> parse_planner_kind(const std::string& text) {
  for (const auto kind : {PlannerKind::kAStar, PlannerKind::kThetaStar, PlannerKind::kRrtConnect,
                          PlannerKind::kRrtStar, PlannerKind::kBitStar, PlannerKind::kPrmStar}) {
    if (text == to_string(kind)) return kind;
  }
  return std::nullopt;
}

void AStarConfig::describe(maps::SettingsVisitor& v) {
  v.integer({.name = "connectivity",
             .help = "Neighbours of a cell in the search: 4 or 8.",
             .min = 4,
             .max = 8},
            connectivity);
  v.real({.name = "soft_cost_weight",
          .help = "How much longer a metre counts right beside an obstacle; 0 plans the shortest "
                  "path.",
          .min = 0.0,
          .max = 50.0,
          .advanced = false},
         soft_cost_weight);
  v.real({.name = "heuristic_weight",
          .help = "Above 1 fewer cells are searched, and the cost is at most this factor from the "
                  "best; with soft costs that need not be faster.",
          .min = 1.0,
          .max = 10.0},
         heuristic_weight);
}

void OmplConfig::describe(maps::SettingsVisitor& v) {
  v.integer({.name = "rrtconnect_iterations",
             .help = "Samples RRTConnect may draw before it gives up.",
             .min = 1,
             .max = 10000000},
            rrtconnect_iterations);
  v.integer({.name = "rrtstar_iterations",
             .help = "Samples RRT* draws; more give a shorter path.",
             .min = 1,
             .max = 10000000},
            rrtstar_iterations);
  v.integer({.name = "bitstar_iterations",
             .help = "Edges BIT* may look at; more give a shorter path.",
             .min = 1,
             .max = 10000000},
            bitstar_iterations);
  v.integer({.name = "prmstar_iterations",
             .help = "Steps of PRM*, two to a sample; more give a shorter path.",
             .min = 1,
             .max = 1000000},
            prmstar_iterations);
  v.real({.name = "rrt_step_m", .help = "Longest edge of the tree.", .min = 0.05, .max = 100.0},
         step_m);
  v.real({.name = "rrt_goal_bias",
          .help = "Share of RRT* samples drawn at the goal itself.",
          .min = 0.0,
          .max = 1.0},
         goal_bias);
}

void SplineConfig::describe(maps::SettingsVisitor& v) {
  v.text({.name = "spline_mode",
          .help = "How the path is rounded: safe keeps clear of obstacles; reference is SciPy's "
                  "smoothing spline through the cells, which may cut through them (the plan then "
                  "says so).",
          .choices = {"safe", "reference"}},
         mode);
  v.real({.name = "spline_smoothing_cells2",
          .help = "Reference mode: bound on the sum of squared distances from the cells, in cells "
                  "squared; 0 passes through all, -1 takes SciPy's default.",
          .min = -1.0,
          .max = 1e6},
         smoothing_cells2);
  v.flag({.name = "smooth_path",
          .help = "Round the path with a cubic B-spline; otherwise drive straight pieces and turn "
                  "in place between them."},
         smooth);
  v.real({.name = "max_curvature_1_m",
          .help = "Tighter bends than this become turns in place.",
          .min = 0.2,
          .max = 50.0},
         max_curvature_1_m);
  v.real({.name = "spline_control_spacing_m",
          .help = "Distance between the spline's control points where there is room.",
          .min = 0.05,
          .max = 5.0},
         control_spacing_m);
  v.real({.name = "path_sample_spacing_m",
          .help = "Distance between the points of the path handed out.",
          .min = 0.005,
          .max = 0.2},
         sample_spacing_m);
}

void TimingConfig::describe(maps::SettingsVisitor& v) {
  v.real({.name = "speed_fraction",
          .help = "Share of the rover's highest speed and turn rate that plans use.",
          .min = 0.05,
          .max = 1.0},
         speed_fraction);
  v.real({.name = "acceleration_fraction",
          .help = "Share of the rover's highest accelerations that plans use.",
          .min = 0.05,
          .max = 1.0},
         acceleration_fraction);
  v.real({.name = "max_lateral_acceleration_m_s2",
          .help = "Highest sideways acceleration in bends.",
          .min = 0.01,
          .max = 10.0},
         max_lateral_acceleration);
  v.real({.name = "turn_first_threshold_rad",
          .help = "When the rover faces further away from the path than this, it turns in place "
                  "first.",
          .min = 0.01,
          .max = 3.2},
         turn_first_threshold_rad);
  v.real({.name = "max_wheel_speed_m_s",
          .help = "Highest speed of either wheel's rim; lowers speed in tight bends.",
          .min = 0.05,
          .max = 2.0},
         max_wheel_speed_m_s);
  v.real({.name = "escape_speed_m_s",
          .help = "Speed while leaving the band around obstacles.",
          .min = 0.02,
          .max = 0.5},
         escape_speed_m_s);
  v.real({.name = "slow_within_m",
          .help = "Nearer to an obstacle than this beyond robot_radius_m the rover is slowed; 0 "
                  "never slows it.",
          .min = 0.0,
          .max = 5.0},
         slow_within_m);
  v.real({.name = "slow_speed_m_s",
          .help = "Speed at robot_radius_m from an obstacle where slow_within_m is set.",
          .min = 0.02,
          .max = 0.8},
         slow_speed_m_s);
  v.real({.name = "trajectory_period_s",
          .help = "Time between trajectory points.",
          .min = 0.002,
          .max = 0.05},
         sample_period_s);
}

void PlannerConfig::describe(maps::SettingsVisitor& v) {
  v.text({.name = "planner",
          .help = "Search method.",
          .choices = {"astar", "thetastar", "rrtconnect", "rrtstar", "bitstar", "prmstar"},
          .advanced = false},
         planner);
  v.text(
      {.name = "footprint",
       .help = "circle keeps robot_radius_m, so that the rover may turn anywhere; rectangle lets "
               "sampling planners through gaps only the oriented footprint fits in. Such plans "
               "are to be looked at: drive refuses them.",
       .choices = {"circle", "rectangle"}},
      footprint);
  v.real({.name = "escape_max_distance_m",
          .help = "A start nearer to an obstacle than the robot's radius, or on unknown ground, "
                  "may be this far from free ground.",
          .min = 0.0,
          .max = 10.0},
         escape_max_distance_m);
  v.real({.name = "drive_margin_m",
          .help = "What drives keep beyond robot_radius_m to obstacles and to ground nobody has "
                  "seen, wherever the way allows: the errors of map and pose.",
          .min = 0.0,
          .max = 1.0,
          .advanced = false},
         drive_margin_m);
  astar.describe(v);
  ompl.describe(v);
  spline.describe(v);
  timing.describe(v);
}

bool plans_with_rectangle(const PlannerConfig& config) { return config.footprint == "rectangle"; }

void validate(const PlannerConfig& config) {
  maps::validate(config);
  if (config.astar.connectivity != 4 && config.astar.connectivity != 8) {
    throw maps::InputError("connectivity = " + std::to_string(config.astar.connectivity) +
                           " must be 4 or 8");
  }
  if (plans_with_rectangle(config) &&
      (config.planner == "astar" || config.planner == "thetastar")) {
    throw maps::InputError("planning.footprint = rectangle needs a sampling planner, not " +
                           config.planner +
                           ": set planner to rrtconnect, rrtstar, bitstar or prmstar");
  }
}

}  // namespace rovigo::planning
