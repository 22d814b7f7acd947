#include "slam/trajectory_file.h"

#include "maps/atomic_file.h"
#include "maps/error.h"
#include "slam/recording/pose_numbers.h"
#include "slam/recording/text_file.h"

namespace rovigo::slam {

void write_tum_trajectory(const std::filesystem::path& path, const std::string& frame,
                          const std::vector<StampedPose>& poses) {
  write_tum_trajectory(path, frame, poses.size(), [&](std::size_t i) { return poses[i]; });
}

void write_tum_trajectory(const std::filesystem::path& path, const std::string& frame,
                          std::size_t count, const std::function<StampedPose(std::size_t)>& pose) {
  constexpr int kTimeDecimals = 7;  // MRPT's clock ticks every 100 ns
  constexpr int kPoseDecimals = 9;
  constexpr std::size_t kLineBytes = 112;  // as most lines have
  std::string text = "# " + frame + "\n# timestamp tx ty tz qx qy qz qw\n";
  text.reserve(text.size() + count * kLineBytes);
  for (std::size_t i = 0; i < count; ++i) {
    const StampedPose stamped = pose(i);
    text += fixed(stamped.time_s, kTimeDecimals);
    for (const double number : numbers_of(stamped.pose)) text += ' ' + fixed(number, kPoseDecimals);
    text += '\n';
  }
  maps::write_file_atomically(path, text);
}

std::vector<StampedPose> read_tum_trajectory(const std::filesystem::path& path) {
  const TextFile file(path);
  std::vector<StampedPose> poses;
  poses.reserve(file.lines().size());
  for (const TextLine& line : file.lines()) {
    file.require_fields(line, 8, "t tx ty tz qx qy qz qw");
    const double time_s = file.time(line, 0);
    if (!poses.empty() && time_s < poses.back().time_s) {
      file.fail(line, "the time lies before the line above; sort the file by time");
    }
    PoseNumbers numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = file.number(line, i + 1);
    const auto pose = pose_from_numbers(numbers);
    if (!pose) {
      file.fail(line, "not a pose: positions must be below 1e6 m and the quaternion's length 1");
    }
    poses.push_back({time_s, *pose});
  }
  if (poses.empty()) throw maps::InputError(path.string() + ": the file holds no poses");
  return poses;
}

}  // namespace rovigo::slam
