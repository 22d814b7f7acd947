#pragma once

#include <filesystem>
#include <memory>

#include "slam/recording/recording.h"

namespace rovigo::slam {

/// ROS 1 bags as RealSense's recorder, ROS's drivers and the TUM benchmark write them. Throws
/// InputError when it is none, or holds no RGB-D frame that can be used.
std::unique_ptr<RecordingReader> open_bag(const std::filesystem::path& path,
                                          const OpenOptions& options);

}  // namespace rovigo::slam
