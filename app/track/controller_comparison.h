#pragma once
// Our controller and the thesis's law on the same drives of a suite.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/console.h"
#include "app/track/track_result.h"

namespace rovigo::app {

/// Cross-track errors of drives that differ in their controller only. A ratio above 1 is in favour
/// of ours. A law that runs away makes an RMS over drives meaningless, so the drives on which the
/// reference arrived are told apart.
struct ControllerComparison {
  std::string what;  ///< "group, trajectory", "group" or "all"
  std::size_t drives = 0;
  std::size_t reference_arrived = 0;
  double rms_m = 0.0, reference_rms_m = 0.0;  ///< root of the mean square of the drives' RMS
  double ratio = 0.0;                         ///< of those two
  double median_ratio = 0.0;                  ///< of the drives' own ratios
  /// The same two over the drives on which the reference arrived; 0 where there is none.
  double arrived_ratio = 0.0, arrived_median_ratio = 0.0;
};

/// For each trajectory of each group, each group, and all; empty without drives to compare.
std::vector<ControllerComparison> compare_controllers(const TrackResult& result);

nlohmann::ordered_json comparison_json(const std::vector<ControllerComparison>& comparisons);
std::vector<Row> comparison_rows(const std::vector<ControllerComparison>& comparisons);

}  // namespace rovigo::app
