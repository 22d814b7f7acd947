#pragma once
// Records a drive with the program, maps the recording in this process, judges it by the truth.

#include <filesystem>
#include <functional>

#include "tests/support/slam_cases.h"

namespace rovigo::test {

struct RecordedDrive {
  std::filesystem::path recording;
  std::filesystem::path truth;  ///< folder
  sim::Scenario scenario;
};

/// Writes `folder`/NAME.rawlog and `folder`/NAME.truth. Throws std::runtime_error with what the
/// program said when it failed.
RecordedDrive record_drive(const Drive& drive, const std::filesystem::path& folder,
                           const std::string& name);

/// Maps it and judges the map.
SlamScore score_drive(const RecordedDrive& drive);

/// Maps a TUM recording whose truth is motion capture.
SlamScore score_tum(const std::filesystem::path& recording);

/// The same drive in steady light: what a light scenario is compared with.
Drive steady(Drive drive);
bool compares_with_steady_light(const SlamCase& c);

}  // namespace rovigo::test
