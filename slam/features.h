#pragma once
// Corners with binary descriptors (ORB: Rublee et al. 2011), spread evenly over the image.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "slam/camera_frame.h"
#include "slam/camera_model.h"
#include "slam/descriptor.h"
#include "slam/floor_depth.h"
#include "slam/rolling_shutter.h"
#include "slam/slam_config.h"

namespace rovigo::slam {

struct Feature {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  ///< ideal, on the full-size image
  float angle_rad = 0.0f;
  float depth_m = 0.0f;  ///< 0: none
  std::uint8_t octave = 0;
};

/// Features of one view, with a lookup by place in the image.
class FeatureSet {
 public:
  FeatureSet() = default;
  FeatureSet(std::vector<Feature> features, std::vector<Descriptor> descriptors, int width,
             int height);

  std::size_t size() const { return features_.size(); }
  const Feature& operator[](std::size_t i) const { return features_[i]; }
  const Descriptor& descriptor(std::size_t i) const { return descriptors_[i]; }
  const std::vector<Feature>& features() const { return features_; }
  const std::vector<Descriptor>& descriptors() const { return descriptors_; }

  /// How unevenly the floor was read that depths were taken on, as a share of the depth; 0:
  /// unknown.
  float floor_roughness() const { return floor_roughness_; }
  void set_floor_roughness(double share) { floor_roughness_ = static_cast<float>(share); }

  /// Appends to `out` the indices of features within a square of half side `radius_px`.
  void near(const Eigen::Vector2d& pixel, double radius_px, std::vector<int>& out) const;

 private:
  static constexpr int kCellPx = 20;
  int columns_ = 0, rows_ = 0;
  float floor_roughness_ = 0.0F;
  std::vector<Feature> features_;
  std::vector<Descriptor> descriptors_;
  std::vector<int> cell_start_;  ///< features sorted by cell, as in a compressed sparse row
  std::vector<int> cell_items_;
};

/// Size of one pixel of a pyramid level on the full-size image.
double octave_scale(int octave, const FeatureConfig& config);

/// Finds corners on every level of the image pyramid and keeps the best of each part of the image.
/// Their pixels are those of an image taken all at once; their depths those of `floor`, where it is
/// known. Corners where something nearer ends before what lies behind are left out: they slide.
FeatureSet extract_features(const CameraFrame& frame, const CameraModel& camera,
                            const FeatureConfig& config, const DepthConfig& depth,
                            const RollingShutter& shutter = {},
                            const std::optional<FloorDepth>& floor = std::nullopt);

}  // namespace rovigo::slam
