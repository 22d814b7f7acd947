#include "sim/depth_camera.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "maps/geometry.h"
#include "sim/glossy_floor.h"

namespace rovigo::sim {
namespace {

constexpr std::uint64_t kColorStream = 1;
constexpr std::uint64_t kDepthStream = 2;
constexpr std::uint64_t kFloorStream = 3;
constexpr int kThreads = 1;

/// Mean of `length` pixels around each (length >= 1, not an integer), along a row of triples.
void blur_row(const float* in, int width, float length, std::vector<float>& sums, float* out) {
  const float reach = 0.5F * (length - 1.0F);
  const int whole = static_cast<int>(reach);
  const float part = reach - static_cast<float>(whole);
  const int pad = whole + 1;
  // Running sums over the row with its ends repeated, so that a mean is a difference of two.
  const auto at = [&](int x, int c) {
    return in[static_cast<std::ptrdiff_t>(std::clamp(x, 0, width - 1)) * 3 + c];
  };
  sums.resize(static_cast<std::size_t>(width + 2 * pad + 1));
  for (int c = 0; c < 3; ++c) {
    sums[0] = 0.0F;
    for (int i = 0; i < width + 2 * pad; ++i) {
      sums[static_cast<std::size_t>(i) + 1] = sums[static_cast<std::size_t>(i)] + at(i - pad, c);
    }
    for (int x = 0; x < width; ++x) {
      const float core = sums[static_cast<std::size_t>(x + pad + whole + 1)] -
                         sums[static_cast<std::size_t>(x + pad - whole)];
      const float ends = part * (at(x - whole - 1, c) + at(x + whole + 1, c));
      out[static_cast<std::ptrdiff_t>(x) * 3 + c] = (core + ends) / length;
    }
  }
}

}  // namespace

DepthCamera::DepthCamera(const WorldModel& world, const CameraNoise& noise, const FloorGloss& floor,
                         const mrpt::img::TCamera& intrinsics, std::uint64_t seed)
    : noise_(noise), floor_(floor), intrinsics_(intrinsics), seed_(seed), renderer_(world) {}

mrpt::obs::CObservation3DRangeScan::Ptr DepthCamera::take(const Shot& shot) {
  renderer_.render({.world_from_camera = shot.world_from_camera,
                    .camera = intrinsics_,
                    .movers = shot.movers,
                    .mirror = floor_.mirror,
                    .threads = kThreads},
                   view_);
  auto obs = mrpt::obs::CObservation3DRangeScan::Create();
  obs->sensorLabel = "camera";
  obs->hasRangeImage = true;
  obs->range_is_depth = true;
  obs->rangeUnits = 0.001F;
  obs->maxRange = static_cast<float>(noise_.max_range_m);
  obs->cameraParams = intrinsics_;
  obs->cameraParamsIntensity = intrinsics_;
  obs->rangeImage_setSize(view_.height, view_.width);
  measure_depth(shot, obs->rangeImage);
  cv::Mat image(view_.height, view_.width, CV_8UC3);
  expose(shot, image);
  obs->hasIntensityImage = true;
  obs->intensityImageChannel = mrpt::obs::CObservation3DRangeScan::CH_VISIBLE;
  obs->intensityImage = mrpt::img::CImage(image, mrpt::img::SHALLOW_COPY);
  return obs;
}

void DepthCamera::expose(const Shot& shot, cv::Mat& image) {
  const double light = shot.covered ? 0.0 : shot.light;
  if (noise_.auto_exposure) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < view_.bgr.size(); i += 3 * 61) {
      sum += static_cast<double>(view_.bgr[i + 1]);
      ++count;
    }
    const double mean = std::max(1e-3, light * sum / static_cast<double>(count));
    const double wanted = std::clamp(noise_.target_brightness / mean, 0.25, 4.0);
    const double follow =
        gain_is_set_ ? 1.0 - std::exp(-shot.interval_s / noise_.auto_exposure_time_s) : 1.0;
    gain_ += (wanted - gain_) * follow;
    gain_is_set_ = true;
  }
  const auto scale = static_cast<float>(255.0 * gain_ * light);
  const auto sigma = static_cast<float>(noise_.color_noise_levels);
  const auto blur_px = static_cast<float>(1.0 + std::abs(shot.yaw_rate_rad_s) * noise_.exposure_s *
                                                    intrinsics_.fx());
  const std::uint64_t stream = derive_seed(derive_seed(seed_, kColorStream), shot.index);
  std::vector<float> blurred(static_cast<std::size_t>(view_.width) * 3);
  std::vector<float> sums;
  for (int y = 0; y < view_.height; ++y) {
    const std::size_t start = static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width);
    const float* row = &view_.bgr[start * 3];
    if (blur_px > 1.05F) {
      blur_row(row, view_.width, blur_px, sums, blurred.data());
      row = blurred.data();
    }
    auto* out = image.ptr<std::uint8_t>(y);
    for (int x = 0; x < view_.width; ++x) {
      std::uint64_t bits = scramble(stream + start + static_cast<std::size_t>(x));
      for (int c = 0; c < 3; ++c, bits >>= 12U) {
        const float value = row[x * 3 + c] * scale + sigma * gaussian_(bits) + 0.5F;
        out[x * 3 + c] = static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F));
      }
    }
  }
}

void DepthCamera::measure_depth(const Shot& shot, mrpt::math::CMatrix_u16& range_mm) const {
  const int width = view_.width;
  const int height = view_.height;
  const auto min_m = static_cast<float>(noise_.min_range_m);
  const auto max_m = static_cast<float>(noise_.max_range_m);
  const auto min_cosine =
      static_cast<float>(std::cos(noise_.max_incidence_deg * maps::kPi / 180.0));
  // disparity = focal length * baseline / depth; equal errors there are sigma z^2 in depth.
  const auto fb = static_cast<float>(intrinsics_.fx() * noise_.baseline_m);
  const auto sigma_px = static_cast<float>(noise_.depth_sigma_per_m) * fb;
  const auto quantum = static_cast<float>(noise_.disparity_quantum_px);
  const int reach = static_cast<int>(std::ceil(noise_.edge_raggedness_px));
  constexpr float kEdgeShare = 0.05F;  // a step of more than this share of the depth is an edge
  const std::uint64_t stream = derive_seed(derive_seed(seed_, kDepthStream), shot.index);
  const PixelRays rays = pixel_rays(shot.world_from_camera, intrinsics_);
  const GlossyFloor floor(floor_, rays, view_, derive_seed(seed_, kFloorStream),
                          derive_seed(stream, kFloorStream));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(x);
      std::uint16_t& out = range_mm(y, x);
      out = 0;
      float z = view_.depth_m[i];
      if (shot.covered) continue;
      bool from_image = false;
      float wave_m = 0.0F;
      if (floor.is_at(i)) {
        const auto reading = floor.at(x, y);
        from_image = reading.from_image;
        if (!(reading.depth_m > 0.0F)) continue;
        if (from_image) z = reading.depth_m;
        if (!from_image) wave_m = reading.depth_m - z;
      }
      // The mirror image is matched however grazing the view of the mirror is.
      if (!from_image && !(view_.cos_incidence[i] >= min_cosine)) continue;
      const std::uint64_t bits = scramble(stream + i);
      if (reach > 0 &&
          !from_image) {  // matching windows straddle edges: the other side's depth, or nothing
        const int span = 2 * reach + 1;
        const int dx = static_cast<int>((bits >> 40U) % static_cast<unsigned>(span)) - reach;
        const int dy = static_cast<int>((bits >> 48U) % static_cast<unsigned>(span)) - reach;
        const int nx = std::clamp(x + dx, 0, width - 1);
        const int ny = std::clamp(y + dy, 0, height - 1);
        const float other =
            view_.depth_m[static_cast<std::size_t>(ny) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(nx)];
        if (!(std::abs(other - z) <= kEdgeShare * z)) {
          if ((bits >> 60U) < 6) continue;
          z = other;
          wave_m = 0.0F;
        }
      }
      z += wave_m;
      if (!(z >= min_m && z <= max_m)) continue;
      float disparity = fb / z + sigma_px * gaussian_(bits);
      if (quantum > 0.0F) disparity = quantum * std::floor(disparity / quantum + 0.5F);
      if (!(disparity > 0.0F)) continue;
      const float measured = fb / disparity;
      if (measured >= min_m && measured <= max_m) {
        out = static_cast<std::uint16_t>(measured * 1000.0F + 0.5F);
      }
    }
  }
}

}  // namespace rovigo::sim
