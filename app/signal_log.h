#pragma once
// Logs of set-points and responses as CSV, for `rovigo identify`.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "control/identification.h"

namespace rovigo::app {

/// A set-point, and what answered to it.
struct SignalLog {
  std::string name;  ///< "forward speed", "turn rate", or the response's column
  std::string setpoint_column;
  std::string response_column;
  std::string unit;  ///< "m/s", "rad/s", or empty
  std::vector<control::IdentificationSample> samples;
};

/// Columns chosen by name instead of by what is known of them.
struct SignalColumns {
  std::optional<std::string> setpoint;
  std::optional<std::string> response;
};

/// A CSV with a header line; what it holds is told by its column names:
/// - a drive's drive.csv (`rovigo drive --report`): forward speed and turn rate;
/// - time_s, setpoint..., response...; or any three columns, taken in that order;
/// - with `columns`, those two, beside a column of times.
/// An empty set-point is the one before, an empty response was not measured. Throws InputError
/// naming file, line and what is missing.
std::vector<SignalLog> read_signal_logs(const std::filesystem::path& file,
                                        const SignalColumns& columns);

}  // namespace rovigo::app
