#pragma once
// Writes ROS 1 bags with ROS's own library, for the tests of our reader. No ROS header shows here:
// those do not compile as C++20.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace rovigo::test {

enum class BagCompression { kNone, kBz2, kLz4 };

struct BagImageData {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t step = 0;
  std::string encoding;
  std::string bytes;
};

struct BagCameraData {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::string model = "plumb_bob";
  std::vector<double> distortion;
  std::array<double, 4> fx_fy_cx_cy{};
};

using BagPose = std::array<double, 7>;  ///< tx ty tz qx qy qz qw

/// Messages are stamped `time_ns` (0: not at all) and recorded at the time of `received`.
class BagWriter {
 public:
  BagWriter(const std::string& path, BagCompression compression);
  ~BagWriter();

  /// When the following messages arrive, in nanoseconds.
  void received(std::uint64_t time_ns);
  void image(const std::string& topic, std::uint64_t time_ns, const std::string& frame,
             const BagImageData& image);
  void compressed_image(const std::string& topic, std::uint64_t time_ns, const std::string& frame,
                        const std::string& format, std::string_view bytes);
  void camera_info(const std::string& topic, std::uint64_t time_ns, const std::string& frame,
                   const BagCameraData& camera);
  /// `lacks_rate`: its covariance says that turn rates are not measured.
  void imu(const std::string& topic, std::uint64_t time_ns, const std::string& frame,
           const std::array<double, 3>& rate, const std::array<double, 3>& force,
           bool lacks_rate = false);
  void odometry(const std::string& topic, std::uint64_t time_ns, const BagPose& odom_from_base);
  void transform_list(const std::string& topic, const std::string& parent, const std::string& child,
                      const BagPose& parent_from_child);
  void transform(const std::string& topic, const BagPose& pose);
  void number(const std::string& topic, float value);
  void text(const std::string& topic, const std::string& text);
  void close();

 private:
  struct Bag;
  std::unique_ptr<Bag> bag_;
};

}  // namespace rovigo::test
