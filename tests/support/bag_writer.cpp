#include "tests/support/bag_writer.h"

#include <geometry_msgs/Transform.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/Float32.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>

namespace rovigo::test {
namespace {

ros::Time time_from(std::uint64_t time_ns) {
  ros::Time time;
  time.fromNSec(time_ns);
  return time;
}

template <class Vector>
void set_vector(Vector& to, const double* from) {
  to.x = from[0];
  to.y = from[1];
  to.z = from[2];
}

template <class Quaternion>
void set_rotation(Quaternion& to, const BagPose& pose) {
  to.x = pose[3];
  to.y = pose[4];
  to.z = pose[5];
  to.w = pose[6];
}

}  // namespace

struct BagWriter::Bag {
  rosbag::Bag bag;
  ros::Time now = ros::Time(1, 0);
};

BagWriter::BagWriter(const std::string& path, BagCompression compression)
    : bag_(std::make_unique<Bag>()) {
  bag_->bag.open(path, rosbag::bagmode::Write);
  bag_->bag.setChunkThreshold(16 * 1024);  // several chunks even in a small bag
  bag_->bag.setCompression(compression == BagCompression::kLz4 ? rosbag::compression::LZ4
                           : compression == BagCompression::kBz2
                               ? rosbag::compression::BZ2
                               : rosbag::compression::Uncompressed);
}

BagWriter::~BagWriter() = default;

void BagWriter::received(std::uint64_t time_ns) { bag_->now = time_from(time_ns); }

void BagWriter::image(const std::string& topic, std::uint64_t time_ns, const std::string& frame,
                      const BagImageData& image) {
  sensor_msgs::Image message;
  message.header.stamp = time_from(time_ns);
  message.header.frame_id = frame;
  message.width = image.width;
  message.height = image.height;
  message.step = image.step;
  message.encoding = image.encoding;
  message.data.assign(image.bytes.begin(), image.bytes.end());
  bag_->bag.write(topic, bag_->now, message);
}

void BagWriter::compressed_image(const std::string& topic, std::uint64_t time_ns,
                                 const std::string& frame, const std::string& format,
                                 std::string_view bytes) {
  sensor_msgs::CompressedImage message;
  message.header.stamp = time_from(time_ns);
  message.header.frame_id = frame;
  message.format = format;
  message.data.assign(bytes.begin(), bytes.end());
  bag_->bag.write(topic, bag_->now, message);
}

void BagWriter::camera_info(const std::string& topic, std::uint64_t time_ns,
                            const std::string& frame, const BagCameraData& camera) {
  sensor_msgs::CameraInfo message;
  message.header.stamp = time_from(time_ns);
  message.header.frame_id = frame;
  message.width = camera.width;
  message.height = camera.height;
  message.distortion_model = camera.model;
  message.D = camera.distortion;
  const auto& [fx, fy, cx, cy] = camera.fx_fy_cx_cy;
  message.K = {fx, 0, cx, 0, fy, cy, 0, 0, 1};
  message.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  message.P = {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0};
  bag_->bag.write(topic, bag_->now, message);
}

void BagWriter::imu(const std::string& topic, std::uint64_t time_ns, const std::string& frame,
                    const std::array<double, 3>& rate, const std::array<double, 3>& force,
                    bool lacks_rate) {
  sensor_msgs::Imu message;
  message.header.stamp = time_from(time_ns);
  message.header.frame_id = frame;
  message.orientation_covariance[0] = -1.0;
  set_vector(message.angular_velocity, rate.data());
  set_vector(message.linear_acceleration, force.data());
  if (lacks_rate) message.angular_velocity_covariance[0] = -1.0;
  bag_->bag.write(topic, bag_->now, message);
}

void BagWriter::odometry(const std::string& topic, std::uint64_t time_ns,
                         const BagPose& odom_from_base) {
  nav_msgs::Odometry message;
  message.header.stamp = time_from(time_ns);
  message.header.frame_id = "odom";
  message.child_frame_id = "base_link";
  set_vector(message.pose.pose.position, odom_from_base.data());
  set_rotation(message.pose.pose.orientation, odom_from_base);
  bag_->bag.write(topic, bag_->now, message);
}

void BagWriter::transform_list(const std::string& topic, const std::string& parent,
                               const std::string& child, const BagPose& parent_from_child) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  message.transforms[0].header.stamp = bag_->now;
  message.transforms[0].header.frame_id = parent;
  message.transforms[0].child_frame_id = child;
  set_vector(message.transforms[0].transform.translation, parent_from_child.data());
  set_rotation(message.transforms[0].transform.rotation, parent_from_child);
  bag_->bag.write(topic, bag_->now, message);
}

void BagWriter::transform(const std::string& topic, const BagPose& pose) {
  geometry_msgs::Transform message;
  set_vector(message.translation, pose.data());
  set_rotation(message.rotation, pose);
  bag_->bag.write(topic, bag_->now, message);
}

void BagWriter::number(const std::string& topic, float value) {
  std_msgs::Float32 message;
  message.data = value;
  bag_->bag.write(topic, bag_->now, message);
}

void BagWriter::text(const std::string& topic, const std::string& text) {
  std_msgs::String message;
  message.data = text;
  bag_->bag.write(topic, bag_->now, message);
}

void BagWriter::close() { bag_->bag.close(); }

}  // namespace rovigo::test
