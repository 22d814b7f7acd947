#pragma once
// Coloured points from the views kept in a map.

#include <mrpt/math/TPoint3D.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "maps/map_file.h"

namespace rovigo::maps {

struct ColoredPoint {
  float x = 0.0F;  ///< metres, map frame
  float y = 0.0F;
  float z = 0.0F;
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
};

/// What one view saw, from where.
struct ViewPoints {
  mrpt::math::TPoint3D camera;
  std::vector<ColoredPoint> points;
};

/// Every `stride`-th pixel of a keyframe that has depth, in the map frame; lens distortion is
/// undone. Without a colour image points are grey. Images of another size than the camera's are
/// taken as scaled. A keyframe without depth gives no points.
/// Throws InputError naming the keyframe for images that cannot be decoded and for a camera without
/// focal length.
ViewPoints view_points(const StoredKeyframe& keyframe, const MapMetadata& metadata, int stride);

/// Averages points in cubes. The result does not depend on the order of hashing.
class VoxelFilter {
 public:
  explicit VoxelFilter(double voxel_m) : voxel_m_(voxel_m) {}
  void add(const std::vector<ColoredPoint>& points);
  /// Sorted by cube: z, then y, then x.
  std::vector<ColoredPoint> points() const;

 private:
  struct Sum {
    double x = 0.0, y = 0.0, z = 0.0;
    std::uint64_t r = 0, g = 0, b = 0;
    std::uint64_t count = 0;
  };
  double voxel_m_;
  std::unordered_map<std::uint64_t, Sum> cubes_;
};

}  // namespace rovigo::maps
