#include "planning/check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace rovigo::planning {

namespace {

// What finite differences and float-sized rounding may add to a limit.
constexpr double kRelative = 0.02;
constexpr double kAbsolute = 1e-3;
constexpr double kClearanceRounding = 2e-6;
constexpr double kSampleSpacingM = 0.002;

class Checker {
 public:
  Checker(const Trajectory& trajectory, const maps::OccupancyGrid& grid,
          const CheckOptions& options)
      : points_(trajectory.points), grid_(grid), options_(options) {}

  TrajectoryReport run() {
    if (points_.empty()) {
      report_.problems.push_back("the trajectory has no points");
      return report_;
    }
    if (!finite_and_ordered()) return report_;
    rest_at_ends();
    motion();
    safety();
    return report_;
  }

 private:
  void complain(const char* what, double value, double limit) {
    char text[160];
    std::snprintf(text, sizeof text, "%s %.6g exceeds %.6g", what, value, limit);
    report_.problems.emplace_back(text);
  }

  bool finite_and_ordered() {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const TrajectoryPoint& p = points_[i];
      if (!maps::is_finite(p.pose) ||
          !std::isfinite(p.time_s + p.speed_m_s + p.yaw_rate_rad_s + p.curvature_1_m)) {
        report_.problems.push_back("point " + std::to_string(i) + " is not finite");
        return false;
      }
      if (i > 0 && p.time_s <= points_[i - 1].time_s) {
        report_.problems.push_back("time does not increase at point " + std::to_string(i));
        return false;
      }
    }
    return true;
  }

  void rest_at_ends() {
    for (const TrajectoryPoint* p : {&points_.front(), &points_.back()}) {
      if (std::abs(p->speed_m_s) > kAbsolute || std::abs(p->yaw_rate_rad_s) > kAbsolute) {
        report_.problems.push_back("not at rest at " + std::to_string(p->time_s) + " s");
      }
    }
  }

  void motion() {
    const MotionLimits& limits = options_.limits;
    for (const TrajectoryPoint& p : points_) {
      grow(report_.max_speed_m_s, std::abs(p.speed_m_s));
      grow(report_.max_yaw_rate_rad_s, std::abs(p.yaw_rate_rad_s));
      grow(report_.max_wheel_speed_m_s,
           std::abs(p.speed_m_s) + 0.5 * limits.track_width_m * std::abs(p.yaw_rate_rad_s));
    }
    for (std::size_t i = 1; i < points_.size(); ++i) step(points_[i - 1], points_[i]);
    const auto limit = [&](const char* what, double value, double most) {
      if (value > most * (1.0 + kRelative) + kAbsolute) complain(what, value, most);
    };
    limit("speed", report_.max_speed_m_s, limits.speed_m_s);
    limit("yaw rate", report_.max_yaw_rate_rad_s, limits.yaw_rate_rad_s);
    limit("wheel speed", report_.max_wheel_speed_m_s, limits.wheel_speed_m_s);
    limit("acceleration", report_.max_acceleration_m_s2, limits.acceleration_m_s2);
    limit("yaw acceleration", report_.max_yaw_acceleration_rad_s2, limits.yaw_acceleration_rad_s2);
    limit("time step", report_.max_time_step_s, 0.05);
    limit("slip", report_.max_slip_m, 0.0);
    limit("heading slip", report_.max_heading_slip, 2e-3);
    limit("side slip", report_.max_side_slip_rad, 0.02);
  }

  void step(const TrajectoryPoint& a, const TrajectoryPoint& b) {
    const double dt = b.time_s - a.time_s;
    const double moved = maps::distance(maps::position_of(a.pose), maps::position_of(b.pose));
    const double turned = maps::wrap_angle(b.pose.phi - a.pose.phi);
    grow(report_.max_time_step_s, dt);
    grow(report_.max_acceleration_m_s2, std::abs(b.speed_m_s - a.speed_m_s) / dt);
    grow(report_.max_yaw_acceleration_rad_s2, std::abs(b.yaw_rate_rad_s - a.yaw_rate_rad_s) / dt);
    grow(report_.max_slip_m, std::abs(moved - 0.5 * (a.speed_m_s + b.speed_m_s) * dt));
    grow(report_.max_heading_slip,
         std::abs(turned - 0.5 * (a.yaw_rate_rad_s + b.yaw_rate_rad_s) * dt));
    if (moved > 1e-4) {
      const double direction = std::atan2(b.pose.y - a.pose.y, b.pose.x - a.pose.x);
      const double heading = a.pose.phi + 0.5 * turned;
      grow(report_.max_side_slip_rad, std::abs(maps::wrap_angle(direction - heading)));
    }
  }

  void safety() {
    const double start_clearance = clearance(points_.front().pose);
    bool escaping = options_.escape_allowed;
    report_.min_clearance_m = options_.clearance_looked_m;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const TPose2D& a = points_[i > 0 ? i - 1 : 0].pose;
      const TPose2D& b = points_[i].pose;
      const double turn = maps::wrap_angle(b.phi - a.phi);
      const double corner_moves =
          0.5 * std::abs(turn) *
          std::hypot(options_.footprint.length_m, options_.footprint.width_m);
      const double moves =
          maps::distance(maps::position_of(a), maps::position_of(b)) + corner_moves;
      const int n = std::max(1, static_cast<int>(std::ceil(moves / kSampleSpacingM)));
      for (int k = 1; k <= n; ++k) {
        const double f = static_cast<double>(k) / n;
        look_at({a.x + f * (b.x - a.x), a.y + f * (b.y - a.y), a.phi + f * turn}, start_clearance,
                escaping);
      }
    }
    if (report_.unsafe_samples > 0) {
      report_.problems.push_back(std::to_string(report_.unsafe_samples) + " unsafe samples of " +
                                 std::to_string(report_.samples) + "; clearance down to " +
                                 std::to_string(report_.min_clearance_m) + " m");
    }
  }

  void look_at(const TPose2D& pose, double start_clearance, bool& escaping) {
    ++report_.samples;
    const double c = clearance(pose);
    const bool fits = has_footprint() ? c > 0.0 : c >= options_.robot_radius_m - kClearanceRounding;
    const bool roomy = fits && !on_blocked_ground(maps::position_of(pose));
    if (escaping && roomy) escaping = false;
    if (escaping) {
      // One cell nearer than at the start is the most an escape may come.
      const double least = std::min(start_clearance, options_.robot_radius_m);
      if (c <= 0.0 || c < least - grid_.geometry.resolution_m - kClearanceRounding) {
        ++report_.unsafe_samples;
      }
      return;
    }
    report_.min_clearance_m = std::min(report_.min_clearance_m, c);
    if (!roomy) ++report_.unsafe_samples;
  }

  /// Off the map or on unknown ground; a point that rounding put across the border is not.
  bool on_blocked_ground(const TPoint2D& p) const {
    for (const double dx : {0.0, -kClearanceRounding, kClearanceRounding}) {
      for (const double dy : {0.0, -kClearanceRounding, kClearanceRounding}) {
        if (is_open({p.x + dx, p.y + dy})) return false;
      }
    }
    return true;
  }

  bool is_open(const TPoint2D& p) const {
    const maps::Cell cell = grid_.geometry.cell_at(p);
    if (!grid_.geometry.contains(cell)) return false;
    return !options_.unknown_is_blocked || !maps::OccupancyGrid::is_unknown(grid_.at(cell));
  }

  bool has_footprint() const { return options_.footprint.length_m > 0.0; }

  /// Of the centre, or of the footprint where there is one.
  double clearance(const TPose2D& pose) const {
    if (!has_footprint()) return clearance(maps::position_of(pose));
    return footprint_clearance(grid_, pose, options_.footprint, options_.clearance_looked_m);
  }

  /// Brute force over all cells within reach.
  double clearance(const TPoint2D& p) const {
    const auto& g = grid_.geometry;
    double best = options_.clearance_looked_m;
    const maps::Cell middle = g.cell_at(p);
    // Rings of cells around the point, until no further ring can be nearer.
    const int rings = static_cast<int>(best / g.resolution_m) + 1;
    for (int ring = 0; ring <= rings && (ring - 1) * g.resolution_m < best; ++ring) {
      for (int y = middle.y - ring; y <= middle.y + ring; ++y) {
        const bool whole_row = y == middle.y - ring || y == middle.y + ring;
        for (int x = middle.x - ring; x <= middle.x + ring;
             x += whole_row ? 1 : 2 * std::max(ring, 1)) {
          const maps::Cell cell{x, y};
          if (!g.contains(cell) || !maps::OccupancyGrid::is_occupied(grid_.at(cell))) continue;
          const TPoint2D center = g.center_of(cell);
          const double dx = std::max(0.0, std::abs(p.x - center.x) - 0.5 * g.resolution_m);
          const double dy = std::max(0.0, std::abs(p.y - center.y) - 0.5 * g.resolution_m);
          best = std::min(best, std::hypot(dx, dy));
        }
      }
    }
    return best;
  }

  static void grow(double& most, double value) { most = std::max(most, value); }

  const std::vector<TrajectoryPoint>& points_;
  const maps::OccupancyGrid& grid_;
  const CheckOptions& options_;
  TrajectoryReport report_;
};

}  // namespace

TrajectoryReport check(const Trajectory& trajectory, const maps::OccupancyGrid& grid,
                       const CheckOptions& options) {
  return Checker(trajectory, grid, options).run();
}

}  // namespace rovigo::planning
