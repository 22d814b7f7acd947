#pragma once
// A room of upright walls, as a depth camera sees it and as a grid: enough to test what works on
// shape alone.

#include <algorithm>
#include <cmath>
#include <vector>

#include "maps/occupancy_grid.h"
#include "slam/camera_frame.h"
#include "slam/se3.h"

namespace rovigo::test {

struct WallSegment {
  TPoint2D a, b;
};

/// The camera sits 0.25 m above the floor, at the rover's origin, and looks along its x.
class DepthRoom {
 public:
  explicit DepthRoom(std::vector<WallSegment> walls) : walls_(std::move(walls)) {}

  static slam::CameraModel camera() {
    mrpt::img::TCamera c;
    c.ncols = 320;
    c.nrows = 240;
    c.setIntrinsicParamsFromValues(280.0, 280.0, 160.0, 120.0);
    return slam::CameraModel(c);
  }
  static slam::Se3 base_from_camera() {
    slam::Se3 pose;
    pose.rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    pose.translation = {0.0, 0.0, 0.25};
    return pose;
  }

  /// 16-bit millimetres along the optical axis; walls have no end upwards or downwards.
  cv::Mat depth(const TPose2D& map_from_base) const {
    const slam::CameraModel model = camera();
    cv::Mat out(model.height(), model.width(), CV_16UC1, cv::Scalar(0));
    for (int u = 0; u < out.cols; ++u) {
      const Eigen::Vector3d ray = model.unproject(Eigen::Vector2d(u, 120.0), 1.0);
      const double z = range(map_from_base, {1.0, -ray.x()});
      out.col(u).setTo(cv::Scalar(z > 0.0 ? std::min(60000.0, 1000.0 * z) : 0.0));
    }
    return out;
  }
  slam::CameraFrame frame(double time_s, const TPose2D& map_from_base) const {
    slam::CameraFrame out;
    out.time_s = time_s;
    out.depth = depth(map_from_base);
    return out;
  }

  /// Free inside the walls' bounding box, walls occupied, the margin around it unknown.
  maps::OccupancyGrid grid(double resolution_m = 0.05, double margin_m = 0.5) const {
    TPoint2D low = walls_.front().a, high = low;
    for (const WallSegment& w : walls_) {
      for (const TPoint2D& p : {w.a, w.b}) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    }
    maps::GridGeometry g;
    g.resolution_m = resolution_m;
    g.origin = {low.x - margin_m, low.y - margin_m};
    g.width = static_cast<int>((high.x - low.x + 2 * margin_m) / resolution_m);
    g.height = static_cast<int>((high.y - low.y + 2 * margin_m) / resolution_m);
    maps::OccupancyGrid out(g);
    for (int y = 0; y < g.height; ++y) {
      for (int x = 0; x < g.width; ++x) {
        const TPoint2D p = g.center_of({x, y});
        const bool inside = p.x > low.x && p.y > low.y && p.x < high.x && p.y < high.y;
        if (inside) out.at({x, y}) = maps::OccupancyGrid::kFree;
      }
    }
    for (const WallSegment& w : walls_) {
      const double length = maps::distance(w.a, w.b);
      for (double s = 0.0; s <= length; s += 0.2 * resolution_m) {
        const double t = s / length;
        out.at(g.cell_at(TPoint2D{w.a.x + t * (w.b.x - w.a.x), w.a.y + t * (w.b.y - w.a.y)})) =
            maps::OccupancyGrid::kOccupied;
      }
    }
    return out;
  }

 private:
  /// Multiples of `direction` (in base_link) to the nearest wall; 0 where there is none.
  double range(const TPose2D& pose, const TPoint2D& direction) const {
    const double c = std::cos(pose.phi), s = std::sin(pose.phi);
    const TPoint2D d{c * direction.x - s * direction.y, s * direction.x + c * direction.y};
    double nearest = 0.0;
    for (const WallSegment& w : walls_) {
      const TPoint2D e = w.b - w.a, to = w.a - TPoint2D{pose.x, pose.y};
      const double across = d.x * e.y - d.y * e.x;
      if (std::abs(across) < 1e-9) continue;
      const double along_ray = (to.x * e.y - to.y * e.x) / across;
      const double along_wall = (to.x * d.y - to.y * d.x) / across;
      if (along_ray <= 0.0 || along_wall < 0.0 || along_wall > 1.0) continue;
      if (nearest == 0.0 || along_ray < nearest) nearest = along_ray;
    }
    return nearest;
  }

  std::vector<WallSegment> walls_;
};

/// 6 m x 4 m, with a partition and a cupboard that make every corner another one.
inline DepthRoom odd_room() {
  return DepthRoom({{{0, 0}, {6, 0}},
                    {{6, 0}, {6, 4}},
                    {{6, 4}, {0, 4}},
                    {{0, 4}, {0, 0}},
                    {{2.5, 0}, {2.5, 1.4}},
                    {{4.8, 4}, {4.8, 3.2}},
                    {{4.8, 3.2}, {6, 3.2}}});
}

/// Nothing tells its four corners apart.
inline DepthRoom square_room() {
  return DepthRoom({{{0, 0}, {4, 0}}, {{4, 0}, {4, 4}}, {{4, 4}, {0, 4}}, {{0, 4}, {0, 0}}});
}

}  // namespace rovigo::test
