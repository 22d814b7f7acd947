#pragma once
// Depth seen by one camera, as another camera beside it would see it.

#include <mrpt/img/TCamera.h>
#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/poses/CPose3D.h>

#include <opencv2/core/types.hpp>
#include <vector>

namespace rovigo::slam {

struct RegistrationGeometry {
  mrpt::img::TCamera depth;
  mrpt::img::TCamera color;
  mrpt::poses::CPose3D color_from_depth;  ///< between the optical frames
};

bool operator==(const RegistrationGeometry& a, const RegistrationGeometry& b);

/// Registers depth images to the colour camera. Every depth pixel is a small square facing the
/// camera; the colour pixels whose centres it covers get its depth along the colour camera's axis,
/// the nearest surface winning. So a colour camera of higher resolution sees no holes, and what the
/// depth camera alone saw behind an edge stays hidden.
class DepthRegistration {
 public:
  explicit DepthRegistration(const RegistrationGeometry& geometry);

  const RegistrationGeometry& geometry() const { return geometry_; }

  /// `depth` in units of `units_m` metres (0 = none), of the depth camera's size; the result has
  /// the colour camera's size and the same units. `is_range`: the values are distances from the
  /// camera's centre, not along its axis.
  mrpt::math::CMatrix_u16 apply(const mrpt::math::CMatrix_u16& depth, double units_m,
                                bool is_range) const;

 private:
  RegistrationGeometry geometry_;
  std::vector<cv::Point2f> corner_rays_;  ///< (columns + 1) x (rows + 1), at a depth of one metre
};

}  // namespace rovigo::slam
