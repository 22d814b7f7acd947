#pragma once
// Recordings of the tests as ROS 1 bags, in the layouts that other programs write.

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>

#include <string>
#include <vector>

#include "slam/recording/recording.h"
#include "tests/support/bag_writer.h"

namespace rovigo::slam::test {

enum class BagStyle {
  kRosDriver,  ///< /camera/color/image_raw and aligned depth, tf_static, /odom, gyro and accel
               ///< apart
  kTum,        ///< /camera/rgb/image_color, /camera/depth/image (32FC1), tf, /imu in base_link
  kRealSenseRecorder,  ///< /device_0/sensor_1/Color_0/image/data and the like; no rover
};

/// RGB-D frames, and the IMU and wheels where the style has them. Depth keeps its unit in 32FC1 and
/// in RealSense's recorder; the driver's style wants millimetres. Messages arrive 40 ms after
/// their stamps, depth images 10 ms later still and stamped 2 ms after the colour image.
void write_bag(const std::string& path, BagStyle style, rovigo::test::BagCompression compression,
               const RecordingInfo& info,
               const std::vector<mrpt::obs::CObservation::Ptr>& observations);

/// Where RealSense's recorder is told that the depth camera sits: color_from_depth.
mrpt::poses::CPose3D recorder_color_from_depth();

/// Observation after observation into a bag of a style.
class BagRecorder {
 public:
  BagRecorder(const std::string& path, BagStyle style, rovigo::test::BagCompression compression,
              const RecordingInfo& info);
  void write(const mrpt::obs::CObservation& observation);
  void finish() { bag_.close(); }

 private:
  void write_rig();
  void write_frame(const mrpt::obs::CObservation3DRangeScan& scan, std::uint64_t time_ns);
  void write_imu(const mrpt::obs::CObservationIMU& imu, std::uint64_t time_ns);

  rovigo::test::BagWriter bag_;
  BagStyle style_;
  RecordingInfo info_;
  bool has_rig_ = false;
};

}  // namespace rovigo::slam::test
