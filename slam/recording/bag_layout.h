#pragma once
// Which topics of a ROS 1 bag are the camera, the IMU and the wheels, and how they sit on the
// rover.

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "slam/recording/bag_survey.h"
#include "slam/recording/recording.h"

namespace rovigo::slam {

struct BagImuSource {
  std::string rate_topic;
  std::string force_topic;  ///< the same topic, or another (RealSense sends them apart)
  mrpt::poses::CPose3D base_from_rate;
  mrpt::poses::CPose3D base_from_force;
};

struct BagLayout {
  std::string color_topic;
  std::string depth_topic;
  mrpt::img::TCamera depth_camera;        ///< equal to rig.camera when depth is registered
  mrpt::poses::CPose3D color_from_depth;  ///< between the optical frames
  float depth_units_m = 0.001F;           ///< of 16-bit images
  std::optional<BagImuSource> imu;
  std::optional<std::string> wheel_topic;
  Rig rig;
  std::vector<std::string> warnings;
};

/// Chooses by message type, image encoding, rate and the names that RealSense, TUM and ROS give
/// their topics. Throws InputError, beginning with `bag`, when there is no colour or depth image,
/// when two are equally likely, or when the calibration is missing; the topics there are are named.
BagLayout choose_layout(const BagSurvey& survey, const std::string& bag,
                        const std::optional<std::filesystem::path>& camera_info);

}  // namespace rovigo::slam
