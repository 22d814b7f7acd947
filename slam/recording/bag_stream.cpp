#include "slam/recording/bag_stream.h"

#include <algorithm>
#include <cmath>

#include "slam/recording/association.h"

namespace rovigo::slam {
namespace {

constexpr std::uint64_t kLookAhead_ns = 300'000'000;
constexpr std::uint64_t kAssociation_ns = 20'000'000;  // as TUM's associate.py
constexpr std::size_t kMostWaiting = 4096;
constexpr std::size_t kMostWaitingBytes = 96u << 20;
constexpr std::size_t kMostRates = 1024;
constexpr std::uint64_t kLongestForceGap_ns = 200'000'000;

std::uint64_t distance(std::uint64_t a, std::uint64_t b) { return a > b ? a - b : b - a; }

double seconds(std::uint64_t time_ns) { return static_cast<double>(time_ns) * 1e-9; }

Eigen::Vector3d rotated(const mrpt::poses::CPose3D& pose, const std::array<double, 3>& v) {
  const Eigen::Matrix3d rotation = pose.getRotationMatrix().asEigen();
  return rotation * Eigen::Vector3d(v[0], v[1], v[2]);
}

/// The stamp, or the time of arrival for messages without one.
std::uint64_t time_of(const BagStamp& stamp, const BagMessage& message) {
  return stamp.time_ns != 0 ? stamp.time_ns : message.received_ns;
}

}  // namespace

BagStream::BagStream(const std::filesystem::path& path, const BagLayout& layout)
    : layout_(layout), name_(path.string()), bag_(path) {
  for (const std::string& warning : layout.warnings) warnings_.add(warning);
}

mrpt::obs::CObservation::Ptr BagStream::next() {
  while (true) {
    while (!is_ready()) read_on();
    if (waiting_.empty()) return nullptr;
    const auto first = waiting_.begin();
    const Key key = first->first;
    Waiting waiting = std::move(first->second);
    waiting_.erase(first);
    mrpt::obs::CObservation::Ptr observation;
    if (auto* const color = std::get_if<Image>(&waiting.what)) {
      waiting_bytes_ -= color->message.data.size();
      observation = make_frame(*color);
    } else {
      observation = std::get<mrpt::obs::CObservation::Ptr>(waiting.what);
    }
    if (!observation) continue;
    if (key < last_) {
      ++late_;
      continue;
    }
    last_ = key;
    observation->timestamp = timestamp_from_nanoseconds(key.first);
    return observation;
  }
}

bool BagStream::is_ready() const {
  if (is_at_end_ || waiting_.size() > kMostWaiting || waiting_bytes_ > kMostWaitingBytes) {
    return true;
  }
  return !waiting_.empty() &&
         distance(latest_received_ns_, waiting_.begin()->second.received_ns) > kLookAhead_ns;
}

void BagStream::read_on() {
  BagMessage message;
  if (!bag_.next(message)) {
    is_at_end_ = true;
    flush_rates(nullptr);
    return;
  }
  latest_received_ns_ = message.received_ns;
  take(bag_.connections().at(message.connection), message);
}

void BagStream::take(const BagConnection& connection, const BagMessage& message) {
  const std::string& topic = connection.topic;
  if (topic == layout_.color_topic) {
    take_image(message, connection.type, false);
  } else if (topic == layout_.depth_topic) {
    take_image(message, connection.type, true);
  } else if (layout_.imu &&
             (topic == layout_.imu->rate_topic || topic == layout_.imu->force_topic)) {
    take_imu(message, topic == layout_.imu->rate_topic, topic == layout_.imu->force_topic);
  } else if (topic == layout_.wheel_topic) {
    take_wheels(message);
  }
}

void BagStream::take_image(const BagMessage& message, const std::string& type, bool is_depth) {
  Image image{0, type == "sensor_msgs/CompressedImage", message};
  std::optional<BagStamp> stamp;
  if (image.is_compressed) {
    if (auto parsed = parse_compressed_image(message.data)) stamp = std::move(parsed->stamp);
  } else {
    if (auto parsed = parse_image(message.data)) stamp = std::move(parsed->stamp);
  }
  colors_ += !is_depth;
  if (!stamp) {
    if (!is_depth) skip_frame("its colour message is damaged");
    return;
  }
  image.time_ns = time_of(*stamp, message);
  waiting_bytes_ += message.data.size();
  if (is_depth) {
    depths_.emplace(image.time_ns, std::move(image));
    return;
  }
  const std::uint64_t time_ns = image.time_ns;
  wait(time_ns, Rank::kFrame, {message.received_ns, std::move(image)});
}

void BagStream::wait(std::uint64_t time_ns, Rank rank, Waiting waiting) {
  waiting_.emplace(Key{time_ns, rank}, std::move(waiting));
}

void BagStream::take_wheels(const BagMessage& message) {
  const auto odometry = parse_odometry(message.data);
  if (!odometry) {
    ++unreadable_;
    return;
  }
  const std::uint64_t time_ns = time_of(odometry->stamp, message);
  WheelSample sample;
  sample.time_s = seconds(time_ns);
  const mrpt::poses::CPose3D& pose = odometry->odom_from_child;
  sample.odom_from_base = {pose.x(), pose.y(), pose.yaw()};
  const bool follows = last_wheels_ && last_wheels_->time_s < sample.time_s;
  auto observation =
      make_odometry_observation(sample, follows ? last_wheels_ : std::optional<WheelSample>());
  last_wheels_ = sample;
  wait(time_ns, Rank::kWheels, {message.received_ns, std::move(observation)});
}

void BagStream::take_imu(const BagMessage& message, bool is_rate, bool is_force) {
  const auto imu = parse_imu(message.data);
  if (!imu || (is_rate && !imu->has_rate) || (is_force && !imu->has_force)) {
    ++unreadable_;
    return;
  }
  const std::uint64_t time_ns = time_of(imu->stamp, message);
  const Eigen::Vector3d rate_rad_s = rotated(layout_.imu->base_from_rate, imu->rate_rad_s);
  const Eigen::Vector3d force_m_s2 = rotated(layout_.imu->base_from_force, imu->force_m_s2);
  if (is_rate && is_force) {
    wait(time_ns, Rank::kImu,
         {message.received_ns, make_imu_observation({seconds(time_ns), rate_rad_s, force_m_s2})});
  } else if (is_rate) {
    rates_.push_back({time_ns, message.received_ns, rate_rad_s});
    if (rates_.size() > kMostRates) rates_.pop_front();
  } else {
    const Force force{time_ns, force_m_s2};
    flush_rates(&force);
    force_ = force;
  }
}

/// Gyro and accelerometer sampled apart: each turn rate gets the force interpolated between the
/// accelerations before and after it, or the only one that is near.
void BagStream::flush_rates(const Force* newer) {
  while (!rates_.empty()) {
    const Rate rate = rates_.front();
    if (newer != nullptr && rate.time_ns > newer->time_ns) return;
    rates_.pop_front();
    const bool has_older = force_ && distance(force_->time_ns, rate.time_ns) < kLongestForceGap_ns;
    const bool has_newer =
        newer != nullptr && distance(newer->time_ns, rate.time_ns) < kLongestForceGap_ns;
    if (!has_older && !has_newer) continue;
    Eigen::Vector3d force = has_newer ? newer->force_m_s2 : force_->force_m_s2;
    if (has_older && has_newer && force_->time_ns < rate.time_ns) {
      const double share = static_cast<double>(rate.time_ns - force_->time_ns) /
                           static_cast<double>(newer->time_ns - force_->time_ns);
      force = force_->force_m_s2 + share * (newer->force_m_s2 - force_->force_m_s2);
    }
    wait(rate.time_ns, Rank::kImu,
         {rate.received_ns, make_imu_observation({seconds(rate.time_ns), rate.rate_rad_s, force})});
  }
}

/// The depth image that goes with the earliest colour image, and no longer those that are older
/// than any colour image to come.
std::optional<BagStream::Image> BagStream::take_partner(std::uint64_t color_ns) {
  while (!depths_.empty() && depths_.begin()->first + kAssociation_ns < color_ns) {
    waiting_bytes_ -= depths_.begin()->second.message.data.size();
    depths_.erase(depths_.begin());
  }
  // Relative to the colour image, so that doubles hold the nanoseconds exactly.
  std::vector<double> colors_s = {0.0};
  std::vector<double> depths_s;
  const auto relative_s = [color_ns](std::uint64_t time_ns) {
    return static_cast<double>(static_cast<std::int64_t>(time_ns - color_ns)) * 1e-9;
  };
  for (const auto& [key, waiting] : waiting_) {
    if (std::holds_alternative<Image>(waiting.what)) colors_s.push_back(relative_s(key.first));
  }
  for (const auto& [time_ns, image] : depths_) depths_s.push_back(relative_s(time_ns));
  const auto pairs = closest_pairs(colors_s, depths_s, relative_s(color_ns + kAssociation_ns));
  if (pairs.empty() || pairs.front().first != 0) return std::nullopt;
  const auto found = std::next(depths_.begin(), static_cast<std::ptrdiff_t>(pairs.front().second));
  Image depth = std::move(found->second);
  constexpr std::size_t kMostOffsets = 1000;
  if (offsets_s_.size() < kMostOffsets) offsets_s_.push_back(relative_s(found->first));
  waiting_bytes_ -= depth.message.data.size();
  depths_.erase(found);
  return depth;
}

mrpt::obs::CObservation::Ptr BagStream::make_frame(const Image& color) {
  const auto depth = take_partner(color.time_ns);
  if (!depth) {
    ++unpaired_;
    return nullptr;
  }
  const Rig& rig = layout_.rig;
  auto scan = make_rgbd_observation(seconds(color.time_ns), rig, layout_.depth_units_m);
  std::string problem = decode(color, *depth, *scan);
  if (problem.empty() && normalizer_.normalize(*scan, problem)) {
    scan->sensorPose = base_from_mrpt_sensor(rig.base_from_camera);  // free of rounding
    return scan;
  }
  skip_frame("at " + time_text(*scan) + " s, " + problem);
  return nullptr;
}

std::string BagStream::decode(const Image& color, const Image& depth,
                              mrpt::obs::CObservation3DRangeScan& scan) {
  std::string problem;
  const std::string_view color_bytes = color.message.data;
  const std::string_view depth_bytes = depth.message.data;
  const cv::Mat bgr = color.is_compressed ? color_of(*parse_compressed_image(color_bytes), problem)
                                          : color_of(*parse_image(color_bytes), problem);
  if (!problem.empty()) return "the colour image cannot be used: " + problem;
  BagDepth values;
  const float units_m = layout_.depth_units_m;
  const bool has_depth =
      depth.is_compressed ? depth_of(*parse_compressed_image(depth_bytes), units_m, values, problem)
                          : depth_of(*parse_image(depth_bytes), units_m, values, problem);
  if (!has_depth) return "the depth image cannot be used: " + problem;
  scan.hasRangeImage = scan.hasIntensityImage = true;
  scan.intensityImage = mrpt::img::CImage(bgr, mrpt::img::SHALLOW_COPY);
  scan.rangeImage.swap(values.values);
  scan.rangeUnits = values.units_m;
  scan.cameraParams = layout_.depth_camera;
  scan.cameraParamsIntensity = layout_.rig.camera;
  const mrpt::poses::CPose3D depth_from_color = -layout_.color_from_depth;
  scan.sensorPose = base_from_mrpt_sensor(layout_.rig.base_from_camera + layout_.color_from_depth);
  scan.relativePoseIntensityWRTDepth = base_from_optical(mrpt::poses::CPose3D()) + depth_from_color;
  return {};
}

void BagStream::skip_frame(const std::string& problem) {
  ++skipped_frames_;
  if (first_frame_problem_.empty()) first_frame_problem_ = problem;
  warnings_.add(name_ + ": a camera frame is left out: " + problem + ".");
}

double BagStream::progress() const {
  return static_cast<double>(bag_.bytes_read()) / static_cast<double>(bag_.bytes_in_all());
}

std::vector<std::string> BagStream::warnings() const {
  WarningList all = warnings_;
  for (const std::string& sentence : bag_.warnings().sentences()) all.add(sentence);
  if (std::string offset = time_offset_warning(offsets_s_); !offset.empty()) {
    all.add(std::move(offset));
  }
  if (unpaired_ > 0) {
    all.add(std::to_string(unpaired_) + " of " + std::to_string(colors_) +
            " colour images have no depth image within 0.02 s and are left out.");
  }
  if (unreadable_ > 0) {
    all.add(std::to_string(unreadable_) +
            " IMU or odometry messages are damaged or not finite and are left out.");
  }
  if (late_ > 0) {
    all.add(std::to_string(late_) + " messages lie before others already read and are left out.");
  }
  return all.sentences();
}

}  // namespace rovigo::slam
