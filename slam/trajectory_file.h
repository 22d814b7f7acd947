#pragma once
// TUM-format trajectory files: `t tx ty tz qx qy qz qw`, the frame named in the first comment line.

#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace rovigo::slam {

struct StampedPose {
  double time_s = 0.0;
  mrpt::poses::CPose3D pose;
};

/// `frame` is e.g. "map_from_base_link". Atomic. Throws InputError when it cannot be written.
void write_tum_trajectory(const std::filesystem::path& path, const std::string& frame,
                          const std::vector<StampedPose>& poses);

/// The same for `count` poses that are made one at a time: an hour holds a great many.
void write_tum_trajectory(const std::filesystem::path& path, const std::string& frame,
                          std::size_t count, const std::function<StampedPose(std::size_t)>& pose);

/// Throws InputError naming file and line for anything that is not 8 finite numbers in time order.
std::vector<StampedPose> read_tum_trajectory(const std::filesystem::path& path);

}  // namespace rovigo::slam
