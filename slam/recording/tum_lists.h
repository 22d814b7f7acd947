#pragma once
// The text lists of a TUM directory: images, their association, IMU samples, wheel odometry.

#include <filesystem>
#include <string>
#include <vector>

#include "slam/recording/observations.h"

namespace rovigo::slam {

struct ImageEntry {
  double time_s = 0.0;
  std::filesystem::path path;  ///< relative to the directory
};

/// A colour image and the depth image taken with it; the time is the colour image's.
struct RgbdEntry {
  double time_s = 0.0;
  double depth_time_s = 0.0;
  std::filesystem::path color;
  std::filesystem::path depth;
};

/// `timestamp path` per line, in strictly rising time; paths stay inside the directory. Throws
/// InputError naming file and line.
std::vector<ImageEntry> read_image_list(const std::filesystem::path& path);

/// Each colour image with the nearest depth image within `max_difference_s`, each image used once,
/// the closest pairs first (as TUM's associate.py does). In time order.
std::vector<RgbdEntry> associate(const std::vector<ImageEntry>& color,
                                 const std::vector<ImageEntry>& depth, double max_difference_s);

/// `t_rgb rgb t_depth depth` per line, or depth first (then the folder must be called depth).
std::vector<RgbdEntry> read_associations(const std::filesystem::path& path);

/// `t wx wy wz ax ay az` per line, time not falling.
std::vector<ImuSample> read_imu(const std::filesystem::path& path);

/// TUM trajectory of base_link in odom; height, roll and pitch are dropped.
std::vector<WheelSample> read_wheel_odometry(const std::filesystem::path& path);

}  // namespace rovigo::slam
