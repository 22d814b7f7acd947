#pragma once
// Filters for depth images as active stereo cameras give them: decimation, edge-preserving
// smoothing, smoothing over time, filling of small holes. 16-bit images, 0: no return.

#include <opencv2/core.hpp>

#include "slam/depth_filter_config.h"

namespace rovigo::slam {

/// Each block of factor x factor pixels becomes the median of its returns, so that an edge stays an
/// edge; nothing where fewer than half of them returned. Rows and columns left over are dropped.
cv::Mat decimate_depth(const cv::Mat& depth, int factor);

struct SpatialDepthFilter {
  double weight = 0.5;       ///< of the pixel against the smoothed neighbour before it, 0..1
  double edge_share = 0.02;  ///< a step of more than this share of the depth is an edge
  int passes = 2;            ///< along rows and columns, forwards and backwards
};

/// Recursive smoothing that stops at edges and holes (the exponential form of the domain transform:
/// Gastal & Oliveira 2011).
void smooth_depth(cv::Mat& depth, const SpatialDepthFilter& filter);

/// Fills gaps in rows up to `widest_px` wide whose two sides agree within `edge_share`, linearly in
/// between. Wider gaps and gaps at edges stay: nothing is invented between two surfaces.
void fill_depth_holes(cv::Mat& depth, int widest_px, double edge_share);

struct TemporalDepthFilterConfig {
  double weight = 0.4;       ///< of the newest image
  double edge_share = 0.02;  ///< a larger change is motion: the newest value is taken as it is
  int hold_frames = 2;  ///< for so many frames a pixel that returns nothing keeps its last value
};

/// Exponential average a pixel; for a camera that stands still.
class TemporalDepthFilter {
 public:
  explicit TemporalDepthFilter(const TemporalDepthFilterConfig& config) : config_(config) {}
  /// Starts anew when the image's size changes.
  void apply(cv::Mat& depth);
  void reset() { mean_.release(); }

 private:
  TemporalDepthFilterConfig config_;
  cv::Mat mean_;    ///< CV_32F
  cv::Mat missed_;  ///< CV_8U, frames in a row without a return
};

/// The chain, in that order. The camera's motion between frames is an argument because smoothing
/// over time is only right while it rests.
class DepthFilter {
 public:
  explicit DepthFilter(const DepthFilterConfig& config) : config_(config), temporal_({}) {}

  /// The same image when nothing is switched on; otherwise a filtered copy.
  cv::Mat apply(const cv::Mat& depth, bool at_rest);

 private:
  DepthFilterConfig config_;
  TemporalDepthFilter temporal_;
};

}  // namespace rovigo::slam
