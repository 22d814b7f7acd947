#pragma once
// What a ROS 1 bag holds, from its index and its first seconds.

#include <map>
#include <optional>
#include <string>

#include "slam/recording/bag_file.h"
#include "slam/recording/bag_images.h"
#include "slam/recording/frame_tree.h"

namespace rovigo::slam {

/// What the first message of an image topic shows.
struct BagImageTopic {
  BagImageKind kind = BagImageKind::kOther;
  bool is_compressed = false;
  std::string encoding;
  std::string frame;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint64_t messages = 0;  ///< 0: unknown
};

struct BagImuTopic {
  std::string frame;
  bool has_rate = false;
  bool has_force = false;
};

/// By topic. `frames` also knows the cameras of RealSense's recorder, which gives their poses in
/// topics of its own; their frames are called by the stream's part of the topic.
struct BagSurvey {
  std::map<std::string, BagImageTopic> images;
  std::map<std::string, BagCameraInfo> camera_infos;
  std::map<std::string, BagImuTopic> imus;
  std::map<std::string, BagOdometry> odometries;
  std::map<std::string, float> depth_units_m;  ///< by sensor, as RealSense's recorder names it
  std::map<std::string, std::string> types;    ///< every topic of the bag
  FrameTree frames;
};

/// Reads until every topic that matters has spoken, at most ten seconds beyond the first image.
/// Throws InputError as BagFile does.
BagSurvey survey_bag(const std::filesystem::path& path);

/// `/device_0/sensor_1/Color_0` of a topic below it, as RealSense's recorder writes them; else
/// empty.
std::string realsense_stream_of(const std::string& topic);

}  // namespace rovigo::slam
