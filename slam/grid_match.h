#pragma once
// A depth scan against an occupancy grid: the likelihood field of Thrun, Burgard & Fox,
// Probabilistic Robotics, section 6.4, with a signed distance so that points behind a surface pull
// as well.

#include <opencv2/core.hpp>
#include <vector>

#include "maps/occupancy_grid.h"
#include "slam/camera_model.h"
#include "slam/planar_information.h"
#include "slam/se3.h"
#include "slam/slam_config.h"

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
  /// How far behind its cell's edge a mapped surface lies, on average.
  double mapped_surface_depth_m() const { return 0.5 * geometry_.resolution_m; }

  /// Of the cell the point lies in: metres to the nearest obstacle's edge (0 inside one, infinity
  /// outside the grid), and whether it has been seen.
  struct CellSample {
    bool known = false;
    double wall_m = 0.0;
  };
  CellSample cell_at(const TPoint2D& point) const;

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

/// How a scan lies on the grid at a pose, without moving it.
struct ScanAgreement {
  int points = 0;
  /// Of them, those near a boundary of free and occupied; what falls on ground nobody has seen
  /// counts for the most part: it neither confirms nor contradicts. 1 without points.
  double share = 1.0;
};
ScanAgreement scan_agreement(const SignedDistanceField& field, const std::vector<ScanPoint>& scan,
                             const TPose2D& map_from_base);

/// The nearest surface at obstacle height in every few image columns.
std::vector<ScanPoint> obstacle_points(const cv::Mat& depth, double unit_m,
                                       const CameraModel& camera, const Se3& base_from_camera,
                                       const SlamConfig& config);

/// Gauss-Newton from the prior pose; the prior holds the directions the scan says nothing about.
/// `surface_depth_m`: how far behind the edge of an occupied cell its surface lies. Half a cell
/// where cells are marked for what was seen somewhere in them, 0 where they are walls themselves.
GridMatch match_scan(const SignedDistanceField& field, const std::vector<ScanPoint>& scan,
                     const TPose2D& prior, const Eigen::Matrix3d& prior_covariance,
                     double surface_depth_m = 0.0);

}  // namespace rovigo::slam
