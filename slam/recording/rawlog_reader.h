#pragma once
// Reader of MRPT rawlogs: ours, and those of other programs.

#include "slam/recording/recording.h"

namespace rovigo::slam {

/// Reads ahead for the camera's calibration and for what other sensors there are, then starts
/// again; never holds more than a few observations. A file cut short gives all that stands before
/// the cut, and a warning. Throws InputError when nothing is readable or no RGB-D frame is in it.
/// Images kept beside a foreign rawlog are found through MRPT's global image folder, which is set
/// here: read one such rawlog at a time.
std::unique_ptr<RecordingReader> open_rawlog(const std::filesystem::path& path,
                                             const OpenOptions& options);

}  // namespace rovigo::slam
