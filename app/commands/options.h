#pragma once
// What each subcommand was asked to do, parsed but not yet checked against files.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace rovigo::app {

/// On every command.
struct CommonOptions {
  std::optional<std::filesystem::path> config;
  std::vector<std::string> set;
  bool json = false;
};

struct RecordOptions : CommonOptions {
  std::string world;
  std::string route;
  std::filesystem::path output;
  std::uint64_t seed = 1;
  std::string scenario = "default";
  double fps = 30.0;
  std::optional<std::filesystem::path> tum;
  std::optional<std::filesystem::path> truth;
};

struct MapOptions : CommonOptions {
  std::filesystem::path recording;
  std::filesystem::path output;
  std::optional<std::filesystem::path> trajectory;
  std::string frame = "base_link";  ///< or "camera"
  std::optional<std::filesystem::path> camera_info;
};

struct LocalizeOptions : CommonOptions {
  std::filesystem::path map;
  std::filesystem::path recording;
  std::optional<std::filesystem::path> trajectory;
  std::optional<std::filesystem::path> health;  ///< CSV, a line a camera frame
  std::string frame = "base_link";
  std::optional<std::filesystem::path> camera_info;
};

struct InfoOptions : CommonOptions {
  std::filesystem::path file;
  std::optional<std::filesystem::path> recover;
};

/// Start, goal and stops of `plan` and `drive`, as written.
struct RouteRequest {
  std::optional<std::string> start;
  std::optional<std::string> goal;
  std::vector<std::string> via;
  std::string order = "given";
  std::optional<std::string> planner;
  std::optional<int> map_mode;
};

struct PlanOptions : CommonOptions {
  std::filesystem::path map;
  RouteRequest route;
  bool point = false;
  std::optional<std::filesystem::path> batch;
  std::optional<std::filesystem::path> path;
  std::optional<std::filesystem::path> image;
  std::uint64_t seed = 1;
};

struct DriveOptions : CommonOptions {
  std::filesystem::path map;
  RouteRequest route;
  std::optional<std::string> world;
  std::string scenario = "default";
  std::optional<std::string> pose;  ///< slam, odometry, perturbed, truth
  std::uint64_t seed = 1;
  std::optional<std::filesystem::path> report;
};

struct DockOptions : CommonOptions {
  std::string world;
  std::optional<int> marker;
  std::optional<std::string> start;
  std::string scenario = "default";
  std::uint64_t seed = 1;
  std::optional<std::filesystem::path> report;
};

struct TrackOptions : CommonOptions {
  std::string suite = "default";
  std::optional<std::string> pose;  ///< instead of what the suite says
  std::optional<std::string> shard;
  std::vector<std::filesystem::path> merge;
  std::optional<unsigned> threads;
  std::optional<std::filesystem::path> against;
  std::optional<std::filesystem::path> report;
};

struct TuneOptions : CommonOptions {
  std::string suite = "tuning";
  std::string method = "optimise";   ///< or "relay"
  std::string scenario = "default";  ///< of the relay experiment
  std::optional<std::string> pose;   ///< instead of what the suite says
  int evaluations = 120;
  std::uint64_t seed = 1;
  std::optional<unsigned> threads;
  std::optional<std::filesystem::path> out;
};

struct IdentifyOptions : CommonOptions {
  std::filesystem::path log;
  std::optional<std::string> setpoint;
  std::optional<std::string> response;
  std::optional<std::filesystem::path> report;
};

struct ExportOptions : CommonOptions {
  std::filesystem::path map;
  std::string format;
  std::filesystem::path output;
};

struct ImportOptions : CommonOptions {
  std::filesystem::path source;
  std::filesystem::path output;
};

struct EvaluateTrajectoryOptions : CommonOptions {
  std::filesystem::path estimate;
  std::filesystem::path truth;
};

struct EvaluateMapOptions : CommonOptions {
  std::filesystem::path map;
  std::filesystem::path truth;
};

struct ConfigOptions : CommonOptions {
  std::optional<std::filesystem::path> check;
  bool markdown = false;
};

// Each returns an ExitCode and throws maps::InputError for bad input.
int run_record(const RecordOptions& options);
int run_map(const MapOptions& options);
int run_localize(const LocalizeOptions& options);
int run_info(const InfoOptions& options);
int run_plan(const PlanOptions& options);
int run_drive(const DriveOptions& options);
int run_dock(const DockOptions& options);
int run_track(const TrackOptions& options);
int run_tune(const TuneOptions& options);
int run_identify(const IdentifyOptions& options);
int run_export(const ExportOptions& options);
int run_import(const ImportOptions& options);
int run_evaluate_trajectory(const EvaluateTrajectoryOptions& options);
int run_evaluate_map(const EvaluateMapOptions& options);
int run_config(const ConfigOptions& options);

}  // namespace rovigo::app
