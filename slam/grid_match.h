#pragma once
// A depth scan against an occupancy grid: the likelihood field of Thrun, Burgard & Fox,
// Probabilistic Robotics, section 6.4, with a signed distance so that points behind a surface pull
// as well.

#include <vector>

#include "maps/occupancy_grid.h"
#include "slam/planar_information.h"

namespace rovigo::slam {

/// Where the camera met something at obstacle height, in base_link.
struct ScanPoint {
  TPoint2D base_point;
  double sigma_m = 0.0;  ///< along the ray
};

/// Metres to the nearest boundary between free and occupied, negative inside obstacles; at cell
/// centres.
class SignedDistanceField {
 public:
  explicit SignedDistanceField(const maps::OccupancyGrid& grid);

  struct Sample {
    bool known = false;  ///< false outside the grid and where it has not been seen
    double meters = 0.0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  };
  /// Bilinear between cell centres.
  Sample at(const TPoint2D& point) const;

 private:
  maps::GridGeometry geometry_;
  std::vector<float> meters_;
  std::vector<bool> known_;
};

struct GridMatch {
  PlanarInformation look;  ///< the scan's own word on the pose, without the prior's
  int points = 0;          ///< that fell on known ground
  double inlier_share = 0.0;
};

/// Gauss-Newton from the prior pose; the prior holds the directions the scan says nothing about.
GridMatch match_scan(const SignedDistanceField& field, const std::vector<ScanPoint>& scan,
                     const TPose2D& prior, const Eigen::Matrix3d& prior_covariance);

}  // namespace rovigo::slam
