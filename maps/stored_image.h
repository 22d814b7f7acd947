#pragma once
// The images of a stored keyframe, decoded. Internal to maps (OpenCV stays private).

#include <opencv2/core.hpp>

#include "maps/map_file.h"

namespace rovigo::maps {

/// CV_16UC1, millimetres, 0 = no return. Throws InputError naming the keyframe when it is none.
cv::Mat decode_depth(const StoredKeyframe& keyframe);

/// CV_8UC3, BGR; empty where the keyframe has no colour image. Throws InputError naming the
/// keyframe for one that cannot be decoded.
cv::Mat decode_color(const StoredKeyframe& keyframe);

}  // namespace rovigo::maps
