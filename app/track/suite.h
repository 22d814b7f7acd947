#pragma once
// A suite of tracking tests as its file describes it. sim/suites/default.yaml shows every key.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "maps/settings.h"

namespace rovigo::app {

/// What is driven. Shapes begin at the origin, heading along x, in an empty hall.
struct TrackShape {
  std::string shape = "straight";  ///< straight circle eight square slalom turn curve random goal
                                   ///< mission recorded
  double length_m = 3.0;           ///< of the whole; of one side or leg for square and turn
  double radius_m = 0.8;           ///< circle, eight
  double angle_deg = 90.0;         ///< turn: in place, between two legs
  double curvature_1_m = 0.8;      ///< largest, of curve, slalom and random
  double wave_m = 2.0;             ///< slalom: length of one wave
  int seed = 1;                    ///< random: which one
  double first_heading_off_deg = 0.0;  ///< the rover is put down turned by this, left positive
  // goal: planned from where rovers are put down in a world, on its true grid; or, on a map file,
  // from where its recording began. mission: start, goal and headings drawn by the run's seed.
  std::string world = "lab";  ///< mission: "random" is another one for each seed
  std::string map;            ///< a map file instead, relative to the suite's folder
  // recorded: where the rover was while `map` was recorded; or a TUM trajectory, begun at the
  // origin in the empty hall.
  std::string file;
  double goal_x_m = 0.0;
  double goal_y_m = 0.0;
  void describe(maps::SettingsVisitor& v);
};

/// A run passes when nothing is above these. What a suite leaves out is not asked for.
struct TrackLimits {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  bool must_reach = true;  ///< reach the goal, without a collision
  double cross_track_rms_m = kNone;
  double cross_track_max_m = kNone;
  double goal_m = kNone;
  double goal_heading_rad = kNone;
  double goal_reversals = kNone;  ///< DriveMetrics::goal_reversals
  double min_duration_s = 0.0;
  double max_duration_s = kNone;
  void describe(maps::SettingsVisitor& v);
};

/// Runs under one disturbance: every trajectory with every controller, speed and seed.
struct TrackGroup {
  std::string name;
  std::string scenario = "default";  ///< as for `drive`: noise, slip, motors
  std::string pose = "perturbed";    ///< or "truth"; on map files also "slam" and "odometry"
  std::vector<std::string> trajectories;
  std::vector<std::string> controllers{"default"};  ///< and "reference"
  std::vector<double> speeds_m_s{0.4};
  std::vector<std::uint64_t> seeds{1};
  TrackLimits limits;
};

struct TrackSuite {
  std::string name;
  std::filesystem::path folder;  ///< what the suite's relative paths start from
  std::map<std::string, TrackShape> trajectories;
  std::vector<TrackGroup> groups;
};

/// One drive of the suite.
struct TrackCase {
  std::string name;  ///< group/trajectory/controller/speed
  std::uint64_t seed = 1;
  std::string trajectory;
  std::string controller;
  double speed_m_s = 0.4;
  std::size_t group = 0;  ///< index into the suite's
};

/// Throws InputError naming file, line, value, limit and, for an unknown word, the nearest one.
TrackSuite load_suite(const std::filesystem::path& file);
/// The same from text; `file` is used in messages and for the suite's name.
TrackSuite parse_suite(const std::string& yaml, const std::string& file);

/// Sorted by name and seed, no two alike.
std::vector<TrackCase> cases_of(const TrackSuite& suite);

}  // namespace rovigo::app
