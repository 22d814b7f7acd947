#pragma once
// The page of a suite of tracking tests: one file that needs nothing but a browser.

#include <optional>
#include <string>
#include <vector>

#include "app/track/drive_series.h"
#include "app/track/track_result.h"

namespace rovigo::app {

struct TrackPageInput {
  TrackResult result;
  std::vector<DriveSeries> series;     ///< of the same runs, in the same order
  std::optional<TrackResult> against;  ///< an earlier result to compare with
  std::string against_name;
};

std::string track_page(const TrackPageInput& input);

}  // namespace rovigo::app
