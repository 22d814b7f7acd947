#include "slam/depth_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace rovigo::slam {

namespace {

constexpr int kMostDecimation = 8;

/// One recursive pass along a line of pixels, `step` elements apart.
void smooth_line(std::uint16_t* line, int n, std::ptrdiff_t step, const SpatialDepthFilter& f) {
  float previous = 0.0f;
  const auto weight = static_cast<float>(f.weight);
  const auto edge = static_cast<float>(f.edge_share);
  for (int i = 0; i < n; ++i, line += step) {
    const auto value = static_cast<float>(*line);
    if (value > 0.0f && previous > 0.0f && std::abs(value - previous) < edge * value) {
      previous += weight * (value - previous);
      *line = static_cast<std::uint16_t>(previous + 0.5f);
    } else {
      previous = value;
    }
  }
}

}  // namespace

cv::Mat decimate_depth(const cv::Mat& depth, int factor) {
  factor = std::clamp(factor, 1, kMostDecimation);
  if (factor == 1) return depth;
  cv::Mat out(depth.rows / factor, depth.cols / factor, CV_16UC1);
  std::array<std::uint16_t, static_cast<std::size_t>(kMostDecimation) * kMostDecimation> block{};
  const int half = (factor * factor + 1) / 2;
  for (int v = 0; v < out.rows; ++v) {
    auto* to = out.ptr<std::uint16_t>(v);
    for (int u = 0; u < out.cols; ++u) {
      int n = 0;
      for (int dv = 0; dv < factor; ++dv) {
        const auto* from = depth.ptr<std::uint16_t>(v * factor + dv) + u * factor;
        for (int du = 0; du < factor; ++du) {
          if (from[du] != 0) block[static_cast<std::size_t>(n++)] = from[du];
        }
      }
      to[u] = 0;
      if (n < half) continue;
      std::nth_element(block.begin(), block.begin() + n / 2, block.begin() + n);
      to[u] = block[static_cast<std::size_t>(n / 2)];
    }
  }
  return out;
}

void smooth_depth(cv::Mat& depth, const SpatialDepthFilter& filter) {
  if (depth.empty()) return;
  const auto row_step = static_cast<std::ptrdiff_t>(depth.step1());
  for (int pass = 0; pass < filter.passes; ++pass) {
    for (int v = 0; v < depth.rows; ++v) {
      auto* row = depth.ptr<std::uint16_t>(v);
      smooth_line(row, depth.cols, 1, filter);
      smooth_line(row + depth.cols - 1, depth.cols, -1, filter);
    }
    for (int u = 0; u < depth.cols; ++u) {
      smooth_line(depth.ptr<std::uint16_t>(0) + u, depth.rows, row_step, filter);
      smooth_line(depth.ptr<std::uint16_t>(depth.rows - 1) + u, depth.rows, -row_step, filter);
    }
  }
}

void fill_depth_holes(cv::Mat& depth, int widest_px, double edge_share) {
  for (int v = 0; v < depth.rows; ++v) {
    auto* row = depth.ptr<std::uint16_t>(v);
    int last = -1;  // column of the last return
    for (int u = 0; u < depth.cols; ++u) {
      if (row[u] == 0) continue;
      const int gap = u - last - 1;
      if (last >= 0 && gap > 0 && gap <= widest_px) {
        const double a = row[last], b = row[u];
        if (std::abs(b - a) <= edge_share * std::min(a, b)) {
          for (int i = last + 1; i < u; ++i) {
            row[i] = static_cast<std::uint16_t>(std::lround(a + (b - a) * (i - last) / (u - last)));
          }
        }
      }
      last = u;
    }
  }
}

void TemporalDepthFilter::apply(cv::Mat& depth) {
  if (mean_.size() != depth.size()) {
    depth.convertTo(mean_, CV_32F);
    missed_ = cv::Mat::zeros(depth.size(), CV_8U);
    return;
  }
  const auto weight = static_cast<float>(config_.weight);
  const auto edge = static_cast<float>(config_.edge_share);
  for (int v = 0; v < depth.rows; ++v) {
    auto* now = depth.ptr<std::uint16_t>(v);
    auto* mean = mean_.ptr<float>(v);
    auto* missed = missed_.ptr<std::uint8_t>(v);
    for (int u = 0; u < depth.cols; ++u) {
      const auto value = static_cast<float>(now[u]);
      if (value == 0.0f) {
        missed[u] = static_cast<std::uint8_t>(std::min(missed[u] + 1, 255));
        if (missed[u] > config_.hold_frames) mean[u] = 0.0f;
      } else {
        missed[u] = 0;
        const bool same = mean[u] > 0.0f && std::abs(value - mean[u]) < edge * value;
        mean[u] = same ? mean[u] + weight * (value - mean[u]) : value;
      }
      now[u] = static_cast<std::uint16_t>(mean[u] + 0.5f);
    }
  }
}

cv::Mat DepthFilter::apply(const cv::Mat& depth, bool at_rest) {
  const DepthFilterConfig& c = config_;
  const bool any = c.depth_decimation > 1 || c.depth_spatial_filter || c.depth_temporal_filter ||
                   c.depth_hole_filling_px > 0;
  if (!any || depth.empty()) return depth;
  cv::Mat out = c.depth_decimation > 1 ? decimate_depth(depth, c.depth_decimation) : depth.clone();
  const SpatialDepthFilter spatial;
  if (c.depth_spatial_filter) smooth_depth(out, spatial);
  if (c.depth_temporal_filter) {
    if (!at_rest) temporal_.reset();
    temporal_.apply(out);
  }
  if (c.depth_hole_filling_px > 0) {
    fill_depth_holes(out, c.depth_hole_filling_px, spatial.edge_share);
  }
  return out;
}

void DepthFilterConfig::describe(maps::SettingsVisitor& v) {
  v.integer({.name = "depth_decimation",
             .help = "Depth images are reduced to the medians of blocks of so many pixels a side.",
             .min = 1,
             .max = kMostDecimation},
            depth_decimation);
  v.flag({.name = "depth_spatial_filter",
          .help = "Smooth depth images within their edges before they enter the grid."},
         depth_spatial_filter);
  v.flag({.name = "depth_temporal_filter",
          .help = "Average depth images over time while the rover rests."},
         depth_temporal_filter);
  v.integer({.name = "depth_hole_filling_px",
             .help = "Widest gap in a row of a depth image that is bridged; 0 for none.",
             .min = 0,
             .max = 64},
            depth_hole_filling_px);
}

}  // namespace rovigo::slam
