#pragma once
// Reader of TUM RGB-D directories, with the rover's optional files (design.md, "A TUM directory
// here").

#include "slam/recording/recording.h"

namespace rovigo::slam {

/// Times, associations and text files are read and checked at once; images one at a time as they
/// are asked for. A text file that cannot be trusted is an error; an image that cannot be read is
/// skipped, counted and named, and only a recording without one readable image is an error.
std::unique_ptr<RecordingReader> open_tum_directory(const std::filesystem::path& directory,
                                                    const OpenOptions& options);

}  // namespace rovigo::slam
