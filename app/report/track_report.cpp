#include "app/report/track_report.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <system_error>

#include "app/report/drive_tables.h"
#include "maps/atomic_file.h"
#include "maps/error.h"

namespace rovigo::app {
namespace {

namespace fs = std::filesystem;

/// A run's name as a file's; names from foreign files must not lead out of the folder.
std::string file_stem(const std::string& name, std::uint64_t seed) {
  std::string stem = name;
  for (char& c : stem) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '.';
    if (!plain) c = '_';
  }
  return stem + "_seed" + std::to_string(seed);
}

std::vector<std::string> trajectory_files(const std::string& name, std::uint64_t seed) {
  const std::string stem = file_stem(name, seed);
  return {stem + "_true.txt", stem + "_estimated.txt"};
}

void write(const fs::path& file, const std::string& bytes) {
  maps::write_file_atomically(file, std::string_view(bytes));
}

}  // namespace

void make_track_folder(const fs::path& dir) {
  std::error_code problem;
  fs::create_directories(dir / "trajectories", problem);
  if (problem || !fs::is_directory(dir / "trajectories")) {
    throw maps::InputError("--report " + dir.string() + ": the folder cannot be made: " +
                           (problem ? problem.message() : "a file of that name is in the way"));
  }
}

void write_trajectories(const fs::path& dir, const TrackRun& run) {
  const auto files = trajectory_files(run.what.name, run.what.seed);
  write(dir / "trajectories" / files[0], trajectory_tum(run.log, WhichPose::kTrue));
  write(dir / "trajectories" / files[1], trajectory_tum(run.log, WhichPose::kEstimated));
}

std::vector<DriveSeries> gather_drives(const std::vector<fs::path>& files,
                                       const TrackResult& result, const fs::path& dir) {
  constexpr std::size_t kMaxTrajectoryBytes = std::size_t{1} << 30U;
  std::map<std::pair<std::string, std::uint64_t>, DriveSeries> found;
  for (const fs::path& file : files) {
    const fs::path folder = file.parent_path();
    if (!fs::exists(folder / "drives.json")) {
      throw maps::InputError("--merge: there is no drives.json beside " + file.string() +
                             ", which --report draws from; run the shards with --report DIR and "
                             "merge their DIR/track.json");
    }
    for (DriveSeries& s : read_series(folder / "drives.json")) {
      for (const std::string& name : trajectory_files(s.name, s.seed)) {
        write(dir / "trajectories" / name,
              maps::read_file(folder / "trajectories" / name, kMaxTrajectoryBytes));
      }
      std::pair key(s.name, s.seed);
      found.emplace(std::move(key), std::move(s));
    }
  }
  std::vector<DriveSeries> drives;
  for (const auto& run : result.runs) {
    const auto it = found.find({run["name"].get<std::string>(), run["seed"].get<std::uint64_t>()});
    if (it == found.end()) {
      throw maps::InputError("--merge: no drives.json beside the files holds run \"" +
                             run["name"].get<std::string>() + "\"; run the shards with --report");
    }
    drives.push_back(it->second);
  }
  return drives;
}

void write_track_report(const fs::path& dir, const TrackPageInput& input) {
  write(dir / "track.json", result_json(input.result).dump(2) + "\n");
  write(dir / "runs.csv", result_csv(input.result));
  write(dir / "drives.json", series_json(input.series).dump() + "\n");
  write(dir / "index.html", track_page(input));  // last: it names all the others
}

}  // namespace rovigo::app
