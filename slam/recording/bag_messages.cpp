#include "slam/recording/bag_messages.h"

#include <cmath>

#include "slam/recording/byte_cursor.h"
#include "slam/recording/pose_numbers.h"
#include "slam/recording/rig_yaml.h"
#include "slam/recording/text_file.h"

namespace rovigo::slam {
namespace {

constexpr std::size_t kMaxCoefficients = 8;

std::string frame_name(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  return std::string(name);
}

std::uint64_t read_time_ns(ByteCursor& cursor) {
  const auto seconds = cursor.number<std::uint32_t>();
  const auto nanoseconds = cursor.number<std::uint32_t>();
  return std::uint64_t{seconds} * 1000000000u + nanoseconds;
}

/// std_msgs/Header.
BagStamp read_stamp(ByteCursor& cursor) {
  BagStamp stamp;
  cursor.number<std::uint32_t>();  // sequence number
  stamp.time_ns = read_time_ns(cursor);
  stamp.frame = frame_name(cursor.counted());
  return stamp;
}

/// Translation, then the quaternion x y z w: a Pose as well as a Transform.
std::optional<mrpt::poses::CPose3D> read_pose(ByteCursor& cursor) {
  return pose_from_numbers(cursor.doubles<7>());
}

}  // namespace

std::optional<BagImage> parse_image(std::string_view bytes) {
  ByteCursor cursor(bytes);
  BagImage image;
  image.stamp = read_stamp(cursor);
  image.height = cursor.number<std::uint32_t>();
  image.width = cursor.number<std::uint32_t>();
  image.encoding = cursor.counted();
  image.is_big_endian = cursor.number<std::uint8_t>() != 0;
  image.step = cursor.number<std::uint32_t>();
  image.data = cursor.counted();
  if (!cursor.ok()) return std::nullopt;
  return image;
}

std::optional<BagCompressedImage> parse_compressed_image(std::string_view bytes) {
  ByteCursor cursor(bytes);
  BagCompressedImage image;
  image.stamp = read_stamp(cursor);
  image.format = cursor.counted();
  image.data = cursor.counted();
  if (!cursor.ok()) return std::nullopt;
  return image;
}

std::optional<BagCameraInfo> parse_camera_info_message(std::string_view bytes) {
  ByteCursor cursor(bytes);
  BagCameraInfo info;
  info.stamp = read_stamp(cursor);
  info.height = cursor.number<std::uint32_t>();
  info.width = cursor.number<std::uint32_t>();
  info.model = cursor.counted();
  const auto count = cursor.number<std::uint32_t>();
  if (count > 64) return std::nullopt;
  for (std::uint32_t i = 0; i < count; ++i) info.distortion.push_back(cursor.number<double>());
  info.k = cursor.doubles<9>();
  cursor.doubles<9>();  // rectification
  info.p = cursor.doubles<12>();
  if (!cursor.ok()) return std::nullopt;
  return info;
}

std::optional<BagImu> parse_imu(std::string_view bytes) {
  ByteCursor cursor(bytes);
  BagImu imu;
  imu.stamp = read_stamp(cursor);
  cursor.doubles<13>();  // orientation and its covariance
  imu.rate_rad_s = cursor.doubles<3>();
  imu.has_rate = cursor.doubles<9>()[0] != -1.0;
  imu.force_m_s2 = cursor.doubles<3>();
  imu.has_force = cursor.doubles<9>()[0] != -1.0;
  if (!cursor.ok()) return std::nullopt;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    imu.has_rate = imu.has_rate && std::isfinite(imu.rate_rad_s[i]);
    imu.has_force = imu.has_force && std::isfinite(imu.force_m_s2[i]);
  }
  return imu;
}

std::optional<BagOdometry> parse_odometry(std::string_view bytes) {
  ByteCursor cursor(bytes);
  BagOdometry odometry;
  odometry.stamp = read_stamp(cursor);
  odometry.child_frame = frame_name(cursor.counted());
  const auto pose = read_pose(cursor);
  if (!cursor.ok() || !pose) return std::nullopt;
  odometry.odom_from_child = *pose;
  return odometry;
}

std::optional<std::vector<BagTransform>> parse_transforms(std::string_view bytes) {
  ByteCursor cursor(bytes);
  std::vector<BagTransform> transforms;
  for (auto count = cursor.number<std::uint32_t>(); count > 0 && cursor.ok(); --count) {
    BagTransform transform;
    transform.parent = read_stamp(cursor).frame;
    transform.child = frame_name(cursor.counted());
    const auto pose = read_pose(cursor);
    if (!cursor.ok() || !pose) continue;
    transform.parent_from_child = *pose;
    transforms.push_back(std::move(transform));
  }
  if (!cursor.ok()) return std::nullopt;
  return transforms;
}

std::optional<mrpt::poses::CPose3D> parse_transform(std::string_view bytes) {
  ByteCursor cursor(bytes);
  const auto pose = read_pose(cursor);
  if (!cursor.ok()) return std::nullopt;
  return pose;
}

std::optional<float> parse_float32(std::string_view bytes) {
  ByteCursor cursor(bytes);
  const auto value = cursor.number<float>();
  if (!cursor.ok()) return std::nullopt;
  return value;
}

std::optional<mrpt::img::TCamera> camera_of(const BagCameraInfo& info, bool is_rectified,
                                            std::string& problem) {
  mrpt::img::TCamera camera;
  camera.ncols = info.width;
  camera.nrows = info.height;
  const bool use_projection = is_rectified && info.p[0] > 0.0;
  if (use_projection) {
    camera.setIntrinsicParamsFromValues(info.p[0], info.p[5], info.p[2], info.p[6]);
  } else {
    camera.setIntrinsicParamsFromValues(info.k[0], info.k[4], info.k[2], info.k[5]);
  }
  bool is_distorted = false;
  for (const double k : info.distortion) is_distorted = is_distorted || k != 0.0;
  is_distorted = is_distorted && !use_projection;
  // plumb_bob and rational_polynomial are ROS's names, (Inverse) Brown Conrady RealSense's.
  const bool is_known = info.model == "plumb_bob" || info.model == "rational_polynomial" ||
                        info.model.find("Brown Conrady") != std::string::npos;
  if (is_distorted && (!is_known || info.distortion.size() > kMaxCoefficients)) {
    problem = "its distortion model " + shown_text(info.model) + " with " +
              std::to_string(info.distortion.size()) +
              " coefficients is neither plumb_bob nor rational_polynomial";
    return std::nullopt;
  }
  for (std::size_t i = 0; is_distorted && i < info.distortion.size(); ++i) {
    camera.dist[i] = info.distortion[i];  // MRPT's order is ROS's: k1 k2 p1 p2 k3 k4 k5 k6
  }
  camera.distortion =
      is_distorted ? mrpt::img::DistortionModel::plumb_bob : mrpt::img::DistortionModel::none;
  problem = camera_problem(camera);
  if (!problem.empty()) return std::nullopt;
  return camera;
}

}  // namespace rovigo::slam
