#pragma once
// How a simulated drive ended, in words and as JSON; `drive` and `track` say it alike.

#include <nlohmann/json.hpp>
#include <string>

#include "control/drive_log.h"
#include "control/tracking_metrics.h"

namespace rovigo::app {

/// How a drive ended, as status, code and one sentence.
struct Outcome {
  std::string status;
  int code = 0;
  std::string message;
};

Outcome outcome_of(const control::DriveLog& log, const control::DriveMetrics& m);

/// The keys of design.md's `drive`.
nlohmann::ordered_json drive_json(const Outcome& outcome, const control::DriveLog& log,
                                  const control::DriveMetrics& m);

}  // namespace rovigo::app
