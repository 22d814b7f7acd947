#pragma once
// The comment that opens a rawlog of Rovigo's: JSON that says what the observations cannot.

#include <optional>
#include <string>

#include "slam/recording/recording.h"

namespace rovigo::slam {

struct RawlogHeader {
  bool has_extrinsics = false;
  bool has_wheels = false;
  bool has_imu = false;
  std::optional<maps::SimulationOrigin> simulation;
};

std::string header_text(const RecordingInfo& info);

/// Empty for a comment that is not ours. Throws InputError (naming `file`) for one that is ours
/// and damaged.
std::optional<RawlogHeader> parse_header(const std::string& text, const std::string& file);

}  // namespace rovigo::slam
