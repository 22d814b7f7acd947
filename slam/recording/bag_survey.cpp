#include "slam/recording/bag_survey.h"

#include <array>
#include <set>

#include "slam/recording/images.h"

namespace rovigo::slam {
namespace {

constexpr std::uint64_t kLongest_ns = 10'000'000'000;    // for topics that begin late
constexpr std::uint64_t kTransforms_ns = 2'000'000'000;  // tf is repeated several times a second

bool is_transform_list(std::string_view type) {
  return type == "tf2_msgs/TFMessage" || type == "tf/tfMessage";
}

bool matters(const BagConnection& connection) {
  constexpr std::array<std::string_view, 5> kTypes = {
      "sensor_msgs/Image", "sensor_msgs/CompressedImage", "sensor_msgs/CameraInfo",
      "sensor_msgs/Imu", "nav_msgs/Odometry"};
  for (const std::string_view type : kTypes) {
    if (connection.type == type) return true;
  }
  return false;
}

bool is_image(const BagConnection& connection) {
  return connection.type == "sensor_msgs/Image" || connection.type == "sensor_msgs/CompressedImage";
}

/// The frame of a message: RealSense's recorder numbers its frames, so its topics say it.
std::string frame_of(const std::string& topic, const std::string& frame_in_header) {
  std::string stream = realsense_stream_of(topic);
  return stream.empty() ? frame_in_header : stream;
}

void take_image(const std::string& topic, const BagMessage& message, BagSurvey& survey) {
  const auto image = parse_image(message.data);
  if (!image) return;
  BagImageTopic& facts = survey.images[topic];
  facts.kind = kind_of_encoding(image->encoding);
  facts.encoding = image->encoding;
  facts.frame = frame_of(topic, image->stamp.frame);
  facts.width = image->width;
  facts.height = image->height;
}

void take_compressed_image(const std::string& topic, const BagMessage& message, BagSurvey& survey) {
  const auto image = parse_compressed_image(message.data);
  if (!image) return;
  BagImageTopic& facts = survey.images[topic];
  facts.is_compressed = true;
  facts.encoding = image->format;
  facts.frame = frame_of(topic, image->stamp.frame);
  const bool is_packed_depth = image->format.find("compressedDepth") != std::string::npos;
  constexpr std::size_t kConfigBytes = 12;
  const EncodedImage header = inspect_image(is_packed_depth && image->data.size() > kConfigBytes
                                                ? image->data.substr(kConfigBytes)
                                                : image->data);
  facts.width = static_cast<std::uint32_t>(header.width);
  facts.height = static_cast<std::uint32_t>(header.height);
  if (is_packed_depth || header.bits == 16) {
    facts.kind = BagImageKind::kDepth;
  } else if (header.kind != EncodedImage::Kind::kUnknown) {
    facts.kind = header.channels == 1 ? BagImageKind::kGrey : BagImageKind::kColor;
  }
}

void take_imu(const std::string& topic, const BagMessage& message, BagSurvey& survey) {
  const auto imu = parse_imu(message.data);
  if (!imu) return;
  BagImuTopic& facts = survey.imus[topic];
  facts.frame = frame_of(topic, imu->stamp.frame);
  // RealSense's drivers send gyro and accelerometer apart and leave the other half zero.
  const bool is_gyro =
      topic.find("gyro") != std::string::npos || topic.find("Gyro") != std::string::npos;
  const bool is_accelerometer =
      topic.find("accel") != std::string::npos || topic.find("Accel") != std::string::npos;
  facts.has_rate = imu->has_rate && (is_gyro || !is_accelerometer);
  facts.has_force = imu->has_force && (is_accelerometer || !is_gyro);
}

/// RealSense's recorder: the pose of each stream, as stream_from_reference, and the depth unit.
void take_realsense_facts(const std::string& topic, const BagConnection& connection,
                          const BagMessage& message, BagSurvey& survey) {
  const std::string stream = realsense_stream_of(topic);
  const std::size_t pose_part = topic.find("/tf/", stream.size());
  if (!stream.empty() && connection.type == "geometry_msgs/Transform" &&
      pose_part == stream.size()) {
    const auto stream_from_reference = parse_transform(message.data);
    if (!stream_from_reference) return;
    const std::string device = stream.substr(0, stream.find('/', 1));
    survey.frames.add(device + "/reference" + topic.substr(pose_part + 3), stream,
                      -*stream_from_reference);
  }
  constexpr std::string_view kUnits = "/option/Depth Units/value";
  const bool has_units = topic.ends_with(kUnits) || topic.ends_with("/option/Depth_Units/value");
  if (has_units && connection.type == "std_msgs/Float32") {
    if (const auto units = parse_float32(message.data)) {
      survey.depth_units_m[topic.substr(0, topic.size() - kUnits.size())] = *units;
    }
  }
}

void take(const BagConnection& connection, const BagMessage& message, BagSurvey& survey) {
  const std::string& topic = connection.topic;
  if (connection.type == "sensor_msgs/Image" && !survey.images.contains(topic)) {
    take_image(topic, message, survey);
  } else if (connection.type == "sensor_msgs/CompressedImage" && !survey.images.contains(topic)) {
    take_compressed_image(topic, message, survey);
  } else if (connection.type == "sensor_msgs/CameraInfo") {
    if (auto info = parse_camera_info_message(message.data)) {
      survey.camera_infos.try_emplace(topic, std::move(*info));
    }
  } else if (connection.type == "sensor_msgs/Imu" && !survey.imus.contains(topic)) {
    take_imu(topic, message, survey);
  } else if (connection.type == "nav_msgs/Odometry") {
    if (auto odometry = parse_odometry(message.data)) {
      survey.odometries.try_emplace(topic, std::move(*odometry));
    }
  } else if (is_transform_list(connection.type)) {
    for (const auto& t : parse_transforms(message.data).value_or(std::vector<BagTransform>())) {
      survey.frames.add(t.parent, t.child, t.parent_from_child);
    }
  } else {
    take_realsense_facts(topic, connection, message, survey);
  }
}

/// Whether there is anything left to wait for.
class Patience {
 public:
  explicit Patience(const BagFile& bag) : is_indexed_(bag.has_index()) {
    for (const auto& [id, connection] : bag.connections()) {
      if (connection.messages > 0 && matters(connection)) silent_.insert(connection.topic);
      has_transforms_ = has_transforms_ || is_transform_list(connection.type);
    }
  }
  void heard(const BagConnection& connection, std::uint64_t received_ns) {
    silent_.erase(connection.topic);
    if (first_image_ns_ == 0 && is_image(connection)) first_image_ns_ = received_ns;
    if (first_image_ns_ != 0 && received_ns > first_image_ns_) {
      waited_ns_ = received_ns - first_image_ns_;
    }
  }
  bool is_over() const {
    if (waited_ns_ > kLongest_ns) return true;
    const bool all_spoke = is_indexed_ && silent_.empty();
    return all_spoke && (!has_transforms_ || waited_ns_ > kTransforms_ns);
  }

 private:
  bool is_indexed_;
  bool has_transforms_ = false;
  std::set<std::string> silent_;
  std::uint64_t first_image_ns_ = 0;
  std::uint64_t waited_ns_ = 0;
};

}  // namespace

std::string realsense_stream_of(const std::string& topic) {
  constexpr std::string_view kDevice = "/device_";
  constexpr std::string_view kSensor = "/sensor_";
  if (!topic.starts_with(kDevice)) return {};
  const std::size_t sensor = topic.find('/', 1);
  if (sensor == std::string::npos || topic.compare(sensor, kSensor.size(), kSensor) != 0) return {};
  const std::size_t stream = topic.find('/', sensor + 1);
  if (stream == std::string::npos) return {};
  const std::size_t end = topic.find('/', stream + 1);
  return end == std::string::npos ? std::string() : topic.substr(0, end);
}

BagSurvey survey_bag(const std::filesystem::path& path) {
  BagFile bag(path);
  BagSurvey survey;
  Patience patience(bag);
  BagMessage message;
  while (!patience.is_over() && bag.next(message)) {
    const BagConnection& connection = bag.connections().at(message.connection);
    take(connection, message, survey);
    patience.heard(connection, message.received_ns);
  }
  for (const auto& [id, connection] : bag.connections()) {
    survey.types[connection.topic] = connection.type;
    const auto image = survey.images.find(connection.topic);
    if (image != survey.images.end()) image->second.messages += connection.messages;
  }
  return survey;
}

}  // namespace rovigo::slam
