#include "app/track/track_result.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "app/simulated_drive.h"
#include "app/text.h"
#include "app/track/controller_comparison.h"
#include "maps/atomic_file.h"
#include "maps/error.h"

namespace rovigo::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxShards = 100000;
constexpr std::size_t kMaxResultBytes = std::size_t{1} << 30U;

/// The figures of a run, in the order of the CSV's columns.
constexpr const char* kFigures[] = {"path_length_m",
                                    "driven_length_m",
                                    "duration_s",
                                    "cross_track_rms_m",
                                    "cross_track_max_m",
                                    "final_position_error_m",
                                    "final_heading_error_rad",
                                    "estimate_rms_m",
                                    "collisions",
                                    "along_track_rms_m",
                                    "along_track_max_m",
                                    "heading_rms_rad",
                                    "overshoot_m",
                                    "settling_s",
                                    "goal_reversals",
                                    "jerk_rms_m_s3",
                                    "saturation_share",
                                    "planned_duration_s",
                                    "time_ratio",
                                    "spl"};

std::pair<std::string, std::uint64_t> key_of(const Json& run) {
  return {run["name"].get<std::string>(), run["seed"].get<std::uint64_t>()};
}

void sort_runs(std::vector<Json>& runs) {
  std::sort(runs.begin(), runs.end(),
            [](const Json& a, const Json& b) { return key_of(a) < key_of(b); });
}

bool is_run(const Json& run) {
  const auto has = [&run](const char* key, auto is) { return run.contains(key) && is(run[key]); };
  const auto text = [](const Json& v) { return v.is_string(); };
  if (!run.is_object() || !has("name", text) || !has("log_hash", text) || !has("status", text) ||
      !has("seed", [](const Json& v) { return v.is_number_unsigned(); }) ||
      !has("passed", [](const Json& v) { return v.is_boolean(); }) ||
      !has("failures", [](const Json& v) { return v.is_array(); })) {
    return false;
  }
  return std::all_of(run["failures"].begin(), run["failures"].end(), text) &&
         std::all_of(std::begin(kFigures), std::end(kFigures), [&](const char* key) {
           return has(key, [](const Json& v) { return v.is_number(); });
         });
}

std::string group_of(const Json& run) {
  const auto name = run["name"].get<std::string>();
  const auto parts = split(name, '/');
  return parts.size() < 3 ? name : parts[0] + ", " + parts[2];
}

std::string joined(const Json& texts) {
  std::vector<std::string> parts;
  for (const auto& t : texts) parts.push_back(t.get<std::string>());
  return join(parts, "; ");
}

}  // namespace

Shard parse_shard(const std::string& text) {
  const auto parts = split(text, '/');
  const auto whole = [&](std::size_t i) -> std::size_t {
    const auto value = parts.size() == 2 ? parse_number(parts[i]) : std::nullopt;
    const bool good = value && *value >= 1.0 && *value <= kMaxShards &&
                      *value == static_cast<double>(static_cast<std::size_t>(*value));
    return good ? static_cast<std::size_t>(*value) : 0;
  };
  const Shard shard{whole(0), whole(1)};
  if (shard.index == 0 || shard.count == 0 || shard.index > shard.count) {
    throw maps::InputError("--shard " + text +
                           ": must be I/N with 1 <= I <= N <= 100000, e.g. 2/8");
  }
  return shard;
}

std::size_t failed_runs(const TrackResult& result) {
  return static_cast<std::size_t>(
      std::count_if(result.runs.begin(), result.runs.end(),
                    [](const Json& run) { return !run["passed"].get<bool>(); }));
}

std::string result_message(const TrackResult& result) {
  const std::size_t failed = failed_runs(result);
  const std::string of = std::to_string(result.runs.size()) + " runs of suite " + result.suite;
  return failed == 0 ? "all " + of + " passed" : std::to_string(failed) + " of " + of + " failed";
}

Json result_json(const TrackResult& result) {
  const std::size_t failed = failed_runs(result);
  std::string lines;
  for (const Json& run : result.runs) {
    const auto [name, seed] = key_of(run);
    lines += name + " " + std::to_string(seed) + " " + run["log_hash"].get<std::string>() + "\n";
  }
  Json object{{"status", failed == 0 ? "ok" : "runs_failed"},
              {"code", failed == 0 ? 0 : 1},
              {"message", result_message(result)},
              {"suite", result.suite},
              {"suite_hash", result.suite_hash},
              {"total_runs", result.total_runs}};
  if (result.shard) {
    object["shard"] =
        std::to_string(result.shard->index) + "/" + std::to_string(result.shard->count);
  }
  object["passed"] = result.runs.size() - failed;
  object["failed"] = failed;
  object["log_hash"] = sha256(lines);
  const auto comparisons = compare_controllers(result);
  if (!comparisons.empty()) object["against_reference"] = comparison_json(comparisons);
  object["runs"] = result.runs;
  return object;
}

std::vector<Row> result_rows(const TrackResult& result) {
  struct Worst {
    std::size_t runs = 0, passed = 0;
    double rms = 0.0, max = 0.0, goal = 0.0;
  };
  std::map<std::string, Worst> groups;
  std::vector<Row> rows;
  for (const Json& run : result.runs) {
    Worst& w = groups[group_of(run)];
    ++w.runs;
    w.passed += run["passed"].get<bool>() ? 1 : 0;
    w.rms = std::max(w.rms, run["cross_track_rms_m"].get<double>());
    w.max = std::max(w.max, run["cross_track_max_m"].get<double>());
    w.goal = std::max(w.goal, run["final_position_error_m"].get<double>());
  }
  for (const auto& [name, w] : groups) {
    rows.emplace_back(name, std::to_string(w.passed) + " of " + std::to_string(w.runs) +
                                " passed; worst: cross-track " + with_unit(w.rms, 4, "m RMS") +
                                ", " + with_unit(w.max, 4, "m at most") + ", goal " +
                                with_unit(w.goal, 4, "m"));
  }
  for (Row& row : comparison_rows(compare_controllers(result))) rows.push_back(std::move(row));
  for (const Json& run : result.runs) {
    if (run["passed"].get<bool>()) continue;
    const auto [name, seed] = key_of(run);
    rows.emplace_back("failed: " + name + ", seed " + std::to_string(seed),
                      joined(run["failures"]));
  }
  return rows;
}

std::string result_csv(const TrackResult& result) {
  std::string out = "name,seed,passed,status";
  for (const char* key : kFigures) out += std::string(",") + key;
  out += ",log_hash\n";
  for (const Json& run : result.runs) {
    const auto [name, seed] = key_of(run);
    out += name + "," + std::to_string(seed) + "," + (run["passed"].get<bool>() ? "1" : "0") + "," +
           run["status"].get<std::string>();
    for (const char* key : kFigures) out += "," + run[key].dump();
    out += "," + run["log_hash"].get<std::string>() + "\n";
  }
  return out;
}

TrackResult read_result(const std::filesystem::path& file) {
  const auto fail = [&file](const std::string& what) -> void {
    throw maps::InputError(file.string() + ": " + what +
                           "; give the output of `rovigo track --json` or a report's track.json");
  };
  const Json object =
      Json::parse(maps::read_file(file, kMaxResultBytes), nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) fail("is not a JSON object");
  TrackResult result;
  for (const char* key : {"suite", "suite_hash"}) {
    if (!object.contains(key) || !object[key].is_string()) fail(std::string("has no ") + key);
  }
  result.suite = object["suite"].get<std::string>();
  result.suite_hash = object["suite_hash"].get<std::string>();
  if (!object.contains("total_runs") || !object["total_runs"].is_number_unsigned()) {
    fail("has no total_runs");
  }
  result.total_runs = object["total_runs"].get<std::size_t>();
  if (!object.contains("runs") || !object["runs"].is_array()) fail("has no runs");
  for (const Json& run : object["runs"]) {
    if (!is_run(run)) fail("run " + std::to_string(result.runs.size() + 1) + " is not complete");
    result.runs.push_back(run);
  }
  return result;
}

TrackResult merge_results(const std::vector<std::filesystem::path>& files) {
  TrackResult merged = read_result(files.front());
  for (std::size_t i = 1; i < files.size(); ++i) {
    const TrackResult more = read_result(files[i]);
    if (std::tie(more.suite, more.suite_hash, more.total_runs) !=
        std::tie(merged.suite, merged.suite_hash, merged.total_runs)) {
      throw maps::InputError(
          files[i].string() + ": is of another suite, other settings or another " +
          "pose source than " + files.front().string() + "; merge only shards of one command line");
    }
    merged.runs.insert(merged.runs.end(), more.runs.begin(), more.runs.end());
  }
  sort_runs(merged.runs);
  for (std::size_t i = 1; i < merged.runs.size(); ++i) {
    if (key_of(merged.runs[i - 1]) != key_of(merged.runs[i])) continue;
    throw maps::InputError("--merge: run \"" + key_of(merged.runs[i]).first +
                           "\" is there twice; give each shard once");
  }
  if (merged.runs.size() != merged.total_runs) {
    throw maps::InputError("--merge: the files hold " + std::to_string(merged.runs.size()) +
                           " of the suite's " + std::to_string(merged.total_runs) +
                           " runs; give every shard");
  }
  return merged;
}

}  // namespace rovigo::app
