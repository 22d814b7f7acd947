#pragma once
// The result of a suite, or of a share of it: what is printed, kept, and put together again.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/console.h"

namespace rovigo::app {

/// Share `index` (from 1) of `count`.
struct Shard {
  std::size_t index = 1;
  std::size_t count = 1;
  bool holds(std::size_t run) const { return run % count == index - 1; }
};
/// "I/N". Throws InputError unless 1 <= I <= N <= 100000.
Shard parse_shard(const std::string& text);

struct TrackResult {
  std::string suite;
  std::string suite_hash;                    ///< over suite, settings and pose source
  std::size_t total_runs = 0;                ///< of the whole suite
  std::optional<Shard> shard;                ///< none: the whole suite
  std::vector<nlohmann::ordered_json> runs;  ///< run_json()s, sorted by name and seed
};

std::size_t failed_runs(const TrackResult& result);

/// design.md's `track`. `log_hash`: SHA-256 over a line "name seed log_hash" for each run.
nlohmann::ordered_json result_json(const TrackResult& result);
std::string result_message(const TrackResult& result);
/// The worst figures of each group, our controller against the thesis's law, the failed runs.
std::vector<Row> result_rows(const TrackResult& result);
/// A line for each run.
std::string result_csv(const TrackResult& result);

/// A file written by `rovigo track --json` or --report. Throws InputError saying what it lacks.
TrackResult read_result(const std::filesystem::path& file);
/// Puts shares together. Throws InputError when they are of different suites or settings, or when
/// runs are missing or twice there.
TrackResult merge_results(const std::vector<std::filesystem::path>& files);

}  // namespace rovigo::app
