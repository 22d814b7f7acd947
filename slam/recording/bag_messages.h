#pragma once
// The ROS 1 messages a recording is made of, read from their serialised bytes without trust. Lists
// are bounded by the bytes that are there, whatever length they claim.

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rovigo::slam {

struct BagStamp {
  std::uint64_t time_ns = 0;  ///< 0: not stamped
  std::string frame;          ///< without a leading slash
};

/// sensor_msgs/Image; the pixels are a view into the message.
struct BagImage {
  BagStamp stamp;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t step = 0;  ///< bytes from row to row
  bool is_big_endian = false;
  std::string encoding;
  std::string_view data;
};

/// sensor_msgs/CompressedImage; `data` is a JPEG or PNG file (compressedDepth: after 12 bytes).
struct BagCompressedImage {
  BagStamp stamp;
  std::string format;
  std::string_view data;
};

/// sensor_msgs/CameraInfo.
struct BagCameraInfo {
  BagStamp stamp;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::string model;
  std::vector<double> distortion;
  std::array<double, 9> k{};
  std::array<double, 12> p{};
};

/// sensor_msgs/Imu, without its orientation. A covariance that begins with -1 says that the IMU
/// does not measure the quantity.
struct BagImu {
  BagStamp stamp;
  std::array<double, 3> rate_rad_s{};
  std::array<double, 3> force_m_s2{};
  bool has_rate = false;
  bool has_force = false;
};

/// nav_msgs/Odometry: the pose, without twist and covariances.
struct BagOdometry {
  BagStamp stamp;
  std::string child_frame;
  mrpt::poses::CPose3D odom_from_child;
};

/// One of a tf2_msgs/TFMessage or tf/tfMessage.
struct BagTransform {
  std::string parent;
  std::string child;
  mrpt::poses::CPose3D parent_from_child;
};

// Each is empty when the bytes are no such message. Poses that are not finite, or whose quaternion
// is no rotation, are left out (transforms) or make the message unusable (odometry).
std::optional<BagImage> parse_image(std::string_view bytes);
std::optional<BagCompressedImage> parse_compressed_image(std::string_view bytes);
std::optional<BagCameraInfo> parse_camera_info_message(std::string_view bytes);
std::optional<BagImu> parse_imu(std::string_view bytes);
std::optional<BagOdometry> parse_odometry(std::string_view bytes);
std::optional<std::vector<BagTransform>> parse_transforms(std::string_view bytes);
std::optional<mrpt::poses::CPose3D> parse_transform(std::string_view bytes);  ///< geometry_msgs
std::optional<float> parse_float32(std::string_view bytes);                   ///< std_msgs

/// The camera model, with image size; `is_rectified`: the images were undistorted, so that the
/// projection matrix holds. Empty, with `problem` set, for a model Rovigo cannot use.
std::optional<mrpt::img::TCamera> camera_of(const BagCameraInfo& info, bool is_rectified,
                                            std::string& problem);

}  // namespace rovigo::slam
