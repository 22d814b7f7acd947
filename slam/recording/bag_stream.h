#pragma once
// The observations of a ROS 1 bag in time order, in bounded memory.

#include <mrpt/obs/CObservation.h>

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "slam/recording/bag_layout.h"
#include "slam/recording/observations.h"
#include "slam/recording/rgbd_normalizer.h"

namespace rovigo::slam {

/// Messages wait until the bag has been read a little further, because images are stamped when
/// they are taken and recorded when they arrive; then they leave in the order of their stamps.
class BagStream {
 public:
  BagStream(const std::filesystem::path& path, const BagLayout& layout);

  /// Null at the end.
  mrpt::obs::CObservation::Ptr next();

  double progress() const;
  int skipped_frames() const { return skipped_frames_; }
  const std::string& first_frame_problem() const { return first_frame_problem_; }
  std::vector<std::string> warnings() const;

 private:
  /// At equal times a frame comes last, so that everything up to it is known.
  enum class Rank { kWheels, kImu, kFrame };
  struct Image {
    std::uint64_t time_ns = 0;
    bool is_compressed = false;
    BagMessage message;
  };
  struct Waiting {
    std::uint64_t received_ns = 0;
    std::variant<mrpt::obs::CObservation::Ptr, Image> what;
  };
  using Key = std::pair<std::uint64_t, Rank>;
  struct Force {
    std::uint64_t time_ns = 0;
    Eigen::Vector3d force_m_s2;
  };

  void read_on();
  bool is_ready() const;
  void take(const BagConnection& connection, const BagMessage& message);
  void take_image(const BagMessage& message, const std::string& type, bool is_depth);
  void take_imu(const BagMessage& message, bool is_rate, bool is_force);
  void flush_rates(const Force* newer);
  void take_wheels(const BagMessage& message);
  void wait(std::uint64_t time_ns, Rank rank, Waiting waiting);
  /// Null when the colour image has no depth image, or one of them is damaged.
  mrpt::obs::CObservation::Ptr make_frame(const Image& color);
  std::optional<Image> take_partner(std::uint64_t color_ns);
  std::string decode(const Image& color, const Image& depth,
                     mrpt::obs::CObservation3DRangeScan& scan);
  void skip_frame(const std::string& problem);

  BagLayout layout_;
  std::string name_;
  BagFile bag_;
  RgbdNormalizer normalizer_;
  std::multimap<Key, Waiting> waiting_;
  std::multimap<std::uint64_t, Image> depths_;
  std::size_t waiting_bytes_ = 0;
  std::uint64_t latest_received_ns_ = 0;
  Key last_{};
  bool is_at_end_ = false;

  struct Rate {
    std::uint64_t time_ns = 0;
    std::uint64_t received_ns = 0;
    Eigen::Vector3d rate_rad_s;
  };
  std::deque<Rate> rates_;      ///< waiting for an acceleration
  std::optional<Force> force_;  ///< the latest
  std::optional<WheelSample> last_wheels_;

  std::vector<double> offsets_s_;  ///< of depth images after their colour images, the first ones
  int colors_ = 0;
  int unpaired_ = 0;
  int unreadable_ = 0;
  int late_ = 0;
  int skipped_frames_ = 0;
  std::string first_frame_problem_;
  WarningList warnings_;
};

}  // namespace rovigo::slam
