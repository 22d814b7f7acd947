#include "tests/support/bag_recording.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <opencv2/imgproc.hpp>

#include "slam/recording/images.h"
#include "slam/recording/observations.h"
#include "slam/recording/pose_numbers.h"

namespace rovigo::slam::test {
namespace {

using mrpt::poses::CPose3D;
using rovigo::test::BagCameraData;
using rovigo::test::BagImageData;

constexpr std::uint64_t kDelay_ns = 40'000'000;
constexpr std::uint64_t kDepthLater_ns = 2'000'000;
const std::string kRecorderColor = "/device_0/sensor_1/Color_0";
const std::string kRecorderDepth = "/device_0/sensor_0/Depth_0";

struct Names {
  std::string color, depth, color_info, depth_info, color_frame, depth_frame, tf;
};

Names names_of(BagStyle style) {
  switch (style) {
    case BagStyle::kTum:
      return {"/camera/rgb/image_color",
              "/camera/depth/image",
              "/camera/rgb/camera_info",
              "/camera/depth/camera_info",
              "/openni_rgb_optical_frame",
              "/openni_rgb_optical_frame",
              "/tf"};
    case BagStyle::kRealSenseRecorder:
      return {kRecorderColor + "/image/data",
              kRecorderDepth + "/image/data",
              kRecorderColor + "/info/camera_info",
              kRecorderDepth + "/info/camera_info",
              "0",
              "0",
              ""};
    default:
      return {"/camera/color/image_raw",
              "/camera/aligned_depth_to_color/image_raw",
              "/camera/color/camera_info",
              "/camera/aligned_depth_to_color/camera_info",
              "camera_color_optical_frame",
              "camera_color_optical_frame",
              "/tf_static"};
  }
}

std::uint64_t nanoseconds_of(const mrpt::obs::CObservation& observation) {
  const std::string text = time_text(observation);  // seconds, a point, seven decimals
  const std::size_t point = text.find('.');
  return std::stoull(text.substr(0, point)) * 1'000'000'000 +
         std::stoull(text.substr(point + 1)) * 100;
}

std::string bytes_of(const cv::Mat& image) {
  return {reinterpret_cast<const char*>(image.data), image.total() * image.elemSize()};
}

BagImageData image_of(const cv::Mat& image, const std::string& encoding) {
  return {static_cast<std::uint32_t>(image.cols), static_cast<std::uint32_t>(image.rows),
          static_cast<std::uint32_t>(static_cast<std::size_t>(image.cols) * image.elemSize()),
          encoding, bytes_of(image)};
}

BagCameraData camera_data_of(const mrpt::img::TCamera& camera) {
  BagCameraData data;
  data.width = camera.ncols;
  data.height = camera.nrows;
  data.distortion.assign(camera.dist.begin(), camera.dist.begin() + 5);
  data.fx_fy_cx_cy = {camera.fx(), camera.fy(), camera.cx(), camera.cy()};
  return data;
}

}  // namespace

CPose3D recorder_color_from_depth() { return {0.015, -0.001, 0.002, 0.004, -0.003, 0.002}; }

BagRecorder::BagRecorder(const std::string& path, BagStyle style,
                         rovigo::test::BagCompression compression, const RecordingInfo& info)
    : bag_(path, compression), style_(style), info_(info) {}

void BagRecorder::write(const mrpt::obs::CObservation& observation) {
  const std::uint64_t time_ns = nanoseconds_of(observation);
  bag_.received(time_ns + kDelay_ns);
  if (!std::exchange(has_rig_, true)) write_rig();
  if (const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation)) {
    write_frame(*scan, time_ns);
  } else if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation)) {
    write_imu(*imu, time_ns);
  } else if (const auto* wheels =
                 dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
    if (style_ == BagStyle::kRealSenseRecorder) return;
    bag_.odometry("/odom", time_ns, numbers_of(CPose3D(wheels->odometry)));
  }
}

void BagRecorder::write_rig() {
  const Names names = names_of(style_);
  const BagCameraData camera = camera_data_of(info_.rig.camera);
  if (style_ == BagStyle::kRealSenseRecorder) {
    const CPose3D depth_from_reference(0.1, 0.2, 0.3, 0.4, 0.1, -0.2);  // the reference may be any
    bag_.transform(kRecorderDepth + "/tf/0", numbers_of(depth_from_reference));
    bag_.transform(kRecorderColor + "/tf/0",
                   numbers_of(recorder_color_from_depth() + depth_from_reference));
    bag_.transform("/device_0/sensor_2/Gyro_0/tf/0", numbers_of(depth_from_reference));
    bag_.transform("/device_0/sensor_2/Accel_0/tf/0", numbers_of(depth_from_reference));
    bag_.camera_info(names.color_info, 0, "0", camera);
    bag_.camera_info(names.depth_info, 0, "0", camera);
    return;
  }
  // Part way along the chain a mount that tilts, so that the order of the links matters.
  const CPose3D base_from_mount(0.1, 0.02, 0.3, 0.2, 0.1, 0.05);
  bag_.transform_list(names.tf, "base_link", "camera_link", numbers_of(base_from_mount));
  bag_.transform_list(names.tf, "camera_link", names.color_frame,
                      numbers_of(-base_from_mount + info_.rig.base_from_camera));
  bag_.transform_list(names.tf, "camera_link", "camera_imu_optical_frame",
                      numbers_of(base_from_optical(CPose3D())));
  bag_.transform_list("/tf", "odom", "base_link", {1, 2, 0, 0, 0, 0, 1});
}

void BagRecorder::write_frame(const mrpt::obs::CObservation3DRangeScan& scan,
                              std::uint64_t time_ns) {
  const Names names = names_of(style_);
  cv::Mat rgb;
  cv::cvtColor(color_view(scan), rgb, cv::COLOR_BGR2RGB);
  bag_.image(names.color, time_ns, names.color_frame, image_of(rgb, "rgb8"));
  if (style_ != BagStyle::kRealSenseRecorder) {
    const BagCameraData camera = camera_data_of(info_.rig.camera);
    bag_.camera_info(names.color_info, time_ns, names.color_frame, camera);
    bag_.camera_info(names.depth_info, time_ns, names.depth_frame, camera);
  } else {
    bag_.number("/device_0/sensor_0/option/Depth Units/value", scan.rangeUnits);
  }
  bag_.received(time_ns + kDelay_ns + 10'000'000);
  const bool is_metres = style_ == BagStyle::kTum;
  const cv::Mat depth = is_metres ? depth_in_metres(scan) : depth_view(scan);
  const std::string units = style_ == BagStyle::kRealSenseRecorder ? "mono16" : "16UC1";
  bag_.image(names.depth, time_ns + kDepthLater_ns, names.depth_frame,
             image_of(depth, is_metres ? "32FC1" : units));
}

void BagRecorder::write_imu(const mrpt::obs::CObservationIMU& imu, std::uint64_t time_ns) {
  const ImuSample sample = imu_sample_of(imu).value();
  const auto in = [](const CPose3D& base_from_imu, const Eigen::Vector3d& v) {
    const Eigen::Matrix3d rotation = base_from_imu.getRotationMatrix().asEigen();
    const Eigen::Vector3d turned = rotation.transpose() * v;
    return std::array<double, 3>{turned.x(), turned.y(), turned.z()};
  };
  const auto rate = [&](const CPose3D& pose) { return in(pose, sample.angular_rate_rad_s); };
  const auto force = [&](const CPose3D& pose) { return in(pose, sample.specific_force_m_s2); };
  if (style_ == BagStyle::kTum) {
    bag_.imu("/imu", time_ns, "/base_link", rate({}), force({}));
  } else if (style_ == BagStyle::kRosDriver) {
    const CPose3D base_from_imu =
        CPose3D(0.1, 0.02, 0.3, 0.2, 0.1, 0.05) + base_from_optical(CPose3D());
    bag_.imu("/camera/gyro/sample", time_ns, "camera_imu_optical_frame", rate(base_from_imu), {});
    bag_.imu("/camera/accel/sample", time_ns, "camera_imu_optical_frame", {}, force(base_from_imu));
  } else {
    const CPose3D base_from_depth = base_from_optical(CPose3D()) + recorder_color_from_depth();
    bag_.imu("/device_0/sensor_2/Gyro_0/imu/data", time_ns, "0", rate(base_from_depth), {});
    bag_.imu("/device_0/sensor_2/Accel_0/imu/data", time_ns, "0", {}, force(base_from_depth));
  }
}

void write_bag(const std::string& path, BagStyle style, rovigo::test::BagCompression compression,
               const RecordingInfo& info,
               const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
  BagRecorder recorder(path, style, compression, info);
  for (const auto& observation : observations) recorder.write(*observation);
  recorder.finish();
}

}  // namespace rovigo::slam::test
