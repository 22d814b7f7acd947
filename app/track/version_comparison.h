#pragma once
// A suite's result against an earlier one: of another version, or with other settings.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/console.h"
#include "app/track/track_result.h"

namespace rovigo::app {

/// Drives that both results hold, by name and seed.
struct VersionComparison {
  std::string what;  ///< "group, controller" or "all"
  std::size_t drives = 0;
  std::size_t same = 0;  ///< to the bit, by log_hash
  std::size_t passed = 0, passed_before = 0;
  double rms_m = 0.0, rms_before_m = 0.0;  ///< root of the mean square of the drives' RMS
};

/// For each controller of each group, and all; empty when no drive is in both.
std::vector<VersionComparison> compare_versions(const TrackResult& now, const TrackResult& before);

nlohmann::ordered_json comparison_json(const std::vector<VersionComparison>& comparisons);
/// `before_name` is told where there is nothing to compare.
std::vector<Row> comparison_rows(const std::vector<VersionComparison>& comparisons,
                                 const std::string& before_name);

}  // namespace rovigo::app
