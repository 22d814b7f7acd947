// The fields of a suite's trajectories and limits, with their ranges.

#include "app/track/suite.h"

namespace rovigo::app {

void TrackShape::describe(maps::SettingsVisitor& v) {
  v.text({.name = "shape",
          .help = "What is driven.",
          .choices = {"straight", "circle", "eight", "square", "slalom", "turn", "curve", "random",
                      "goal", "mission", "recorded"}},
         shape);
  v.real({.name = "length_m",
          .help = "Of the whole; of one side or leg for square and turn.",
          .min = 0.2,
          .max = 20},
         length_m);
  v.real({.name = "radius_m", .help = "Of circle and eight.", .min = 0.2, .max = 3}, radius_m);
  v.real({.name = "angle_deg", .help = "Of the turn in place.", .min = -180, .max = 180},
         angle_deg);
  v.real({.name = "curvature_1_m",
          .help = "Largest curvature of curve, slalom and random.",
          .min = -4,
          .max = 4},
         curvature_1_m);
  v.real({.name = "wave_m", .help = "Length of a slalom's wave.", .min = 0.5, .max = 20}, wave_m);
  v.integer({.name = "seed", .help = "Which random one.", .min = 0, .max = 1e9}, seed);
  v.real({.name = "first_heading_off_deg",
          .help = "How far the rover's first heading is off, left positive.",
          .min = -180,
          .max = 180},
         first_heading_off_deg);
  v.text({.name = "world",
          .help = "Where goal or mission lie: a world's name, random:SEED or a file; for missions "
                  "also random, another one for each seed."},
         world);
  v.text({.name = "map",
          .help = "Goal, mission or recorded drive on this map file, relative to the suite."},
         map);
  v.text({.name = "file", .help = "Recorded drive without a map: a TUM trajectory of base_link."},
         file);
  v.real({.name = "goal_x_m", .help = "The goal, world frame.", .min = -1000, .max = 1000},
         goal_x_m);
  v.real({.name = "goal_y_m", .help = "The goal, world frame.", .min = -1000, .max = 1000},
         goal_y_m);
}

void TrackLimits::describe(maps::SettingsVisitor& v) {
  constexpr double kFar = 1000.0;
  v.flag({.name = "must_reach", .help = "Reach the goal, without a collision."}, must_reach);
  v.real({.name = "cross_track_rms_m", .help = "Cross-track error, RMS.", .min = 0, .max = kFar},
         cross_track_rms_m);
  v.real({.name = "cross_track_max_m", .help = "Largest cross-track error.", .min = 0, .max = kFar},
         cross_track_max_m);
  v.real({.name = "goal_m", .help = "Distance from the goal at the end.", .min = 0, .max = kFar},
         goal_m);
  v.real({.name = "goal_heading_rad", .help = "Heading error at the end.", .min = 0, .max = 3.2},
         goal_heading_rad);
  v.real({.name = "goal_reversals",
          .help = "Changes of turning direction at the goal.",
          .min = 0,
          .max = kFar},
         goal_reversals);
  v.real({.name = "min_duration_s", .help = "Shortest drive.", .min = 0, .max = 1e5},
         min_duration_s);
  v.real({.name = "max_duration_s", .help = "Longest drive.", .min = 0, .max = 1e5},
         max_duration_s);
}

}  // namespace rovigo::app
