#include "slam/recording/tum_lists.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "maps/error.h"
#include "slam/recording/association.h"
#include "slam/recording/text_file.h"
#include "slam/trajectory_file.h"

namespace rovigo::slam {
namespace {

std::filesystem::path image_path(const TextFile& file, const TextLine& line, std::size_t index) {
  std::filesystem::path path(line.fields.at(index));
  const bool leaves = std::any_of(path.begin(), path.end(),
                                  [](const std::filesystem::path& part) { return part == ".."; });
  if (path.is_absolute() || leaves) {
    file.fail(line, "the image's path must stay inside the recording's folder");
  }
  return path;
}

/// `t` after `previous`; equal times are allowed only where `strictly` is false.
void require_order(const TextFile& file, const TextLine& line, double t, double previous,
                   bool strictly) {
  if (t < previous || (strictly && t == previous)) {
    file.fail(line, "the time does not come after the line before; sort the file by time");
  }
}

bool names_depth(const std::filesystem::path& path) {
  return path.string().find("depth") != std::string::npos;
}

std::vector<double> times_of(const std::vector<ImageEntry>& images) {
  std::vector<double> times_s;
  times_s.reserve(images.size());
  for (const ImageEntry& image : images) times_s.push_back(image.time_s);
  return times_s;
}

}  // namespace

std::vector<ImageEntry> read_image_list(const std::filesystem::path& path) {
  const TextFile file(path);
  std::vector<ImageEntry> entries;
  entries.reserve(file.lines().size());
  for (const TextLine& line : file.lines()) {
    file.require_fields(line, 2, "time and path");
    const double time_s = file.time(line, 0);
    if (!entries.empty()) require_order(file, line, time_s, entries.back().time_s, true);
    entries.push_back({time_s, image_path(file, line, 1)});
  }
  if (entries.empty()) throw maps::InputError(path.string() + ": no images are listed");
  return entries;
}

std::vector<RgbdEntry> associate(const std::vector<ImageEntry>& color,
                                 const std::vector<ImageEntry>& depth, double max_difference_s) {
  std::vector<RgbdEntry> pairs;
  for (const auto& [i, j] : closest_pairs(times_of(color), times_of(depth), max_difference_s)) {
    pairs.push_back({color[i].time_s, depth[j].time_s, color[i].path, depth[j].path});
  }
  return pairs;
}

std::vector<RgbdEntry> read_associations(const std::filesystem::path& path) {
  const TextFile file(path);
  std::vector<RgbdEntry> pairs;
  for (const TextLine& line : file.lines()) {
    file.require_fields(line, 4, "time, colour image, time, depth image");
    std::filesystem::path color = image_path(file, line, 1);
    std::filesystem::path depth = image_path(file, line, 3);
    double time_s = file.time(line, 0);
    double depth_time_s = file.time(line, 2);
    if (names_depth(color) && !names_depth(depth)) {
      std::swap(color, depth);
      std::swap(time_s, depth_time_s);
    }
    if (!pairs.empty()) require_order(file, line, time_s, pairs.back().time_s, true);
    pairs.push_back({time_s, depth_time_s, std::move(color), std::move(depth)});
  }
  if (pairs.empty()) throw maps::InputError(path.string() + ": no images are listed");
  return pairs;
}

std::vector<ImuSample> read_imu(const std::filesystem::path& path) {
  constexpr double kLargest = 1e4;  // rad/s and m/s^2; far beyond any sensor
  const TextFile file(path);
  std::vector<ImuSample> samples;
  samples.reserve(file.lines().size());
  for (const TextLine& line : file.lines()) {
    file.require_fields(line, 7, "t wx wy wz ax ay az");
    ImuSample sample;
    sample.time_s = file.time(line, 0);
    for (int axis = 0; axis < 3; ++axis) {
      const auto column = static_cast<std::size_t>(axis);
      sample.angular_rate_rad_s[axis] = file.number(line, 1 + column);
      sample.specific_force_m_s2[axis] = file.number(line, 4 + column);
    }
    const double largest = std::max(sample.angular_rate_rad_s.cwiseAbs().maxCoeff(),
                                    sample.specific_force_m_s2.cwiseAbs().maxCoeff());
    if (largest > kLargest) file.fail(line, "a rate or force beyond 10000 is no measurement");
    if (!samples.empty()) require_order(file, line, sample.time_s, samples.back().time_s, false);
    samples.push_back(sample);
  }
  return samples;
}

std::vector<WheelSample> read_wheel_odometry(const std::filesystem::path& path) {
  std::vector<WheelSample> samples;
  for (const StampedPose& stamped : read_tum_trajectory(path)) {
    samples.push_back({stamped.time_s, {stamped.pose.x(), stamped.pose.y(), stamped.pose.yaw()}});
  }
  return samples;
}

}  // namespace rovigo::slam
