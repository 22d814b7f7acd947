#pragma once
// What a map file keeps of a keyframe: its features as bytes only slam reads, its images encoded.

#include <opencv2/core.hpp>
#include <vector>

#include "maps/map_file.h"
#include "slam/camera_frame.h"
#include "slam/descriptor.h"

namespace rovigo::slam {

/// One landmark as one keyframe sees it.
struct StoredFeature {
  float pixel_u = 0, pixel_v = 0;  ///< ideal
  float angle_rad = 0;
  float depth_m = 0;  ///< 0: none
  std::uint8_t octave = 0;
  std::int32_t landmark = -1;                   ///< the same in every keyframe that sees it
  float point_x = 0, point_y = 0, point_z = 0;  ///< optimised, in this keyframe's camera frame
  float sigma_m = 0;                            ///< of the point
  Descriptor descriptor{};

  friend bool operator==(const StoredFeature&, const StoredFeature&) = default;
};

maps::Blob encode_features(const std::vector<StoredFeature>& features);

/// Throws InputError for bytes that are not whole, finite, sane features of this version.
std::vector<StoredFeature> decode_features(const maps::Blob& blob);

maps::Blob encode_color(const cv::Mat& color);
/// 16-bit PNG, 1 mm a unit, of every second pixel in both directions: clouds and grids made from
/// it lose nothing that shows, and map files are less than half as large.
maps::Blob encode_depth(const CameraFrame& frame);
/// Brought back to `size` by repeating pixels. Throws InputError when the blob is not a 16-bit
/// image.
cv::Mat decode_depth(const maps::Blob& png, const cv::Size& size);

inline constexpr double kStoredDepthUnitM = 0.001;  ///< of a keyframe's depth image

}  // namespace rovigo::slam
