#include "control/trajectory_legs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "maps/error.h"

namespace rovigo::control {
namespace {

using planning::TrajectoryPoint;

constexpr double kLargest = 1e6;  // metres, seconds: differences stay exact and finite
constexpr double kNoLengthM = 1e-7;
constexpr double kNoTurnRad = 1e-7;
constexpr double kAtRestMS = 1e-6;

void require_usable(const planning::Trajectory& trajectory) {
  const auto& points = trajectory.points;
  if (points.empty()) throw maps::InputError("The trajectory has no points; plan one first.");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TrajectoryPoint& p = points[i];
    for (const double v : {p.time_s, p.pose.x, p.pose.y, p.pose.phi, p.speed_m_s, p.yaw_rate_rad_s,
                           p.curvature_1_m}) {
      if (std::abs(v) <= kLargest) continue;  // NaN is not
      throw maps::InputError("Trajectory point " + std::to_string(i) + " holds " +
                             std::to_string(v) + ", which is no figure of an indoor drive.");
    }
    if (i > 0 && p.time_s < points[i - 1].time_s) {
      throw maps::InputError("Trajectory point " + std::to_string(i) + " has time " +
                             std::to_string(p.time_s) + " s, before the point ahead of it.");
    }
  }
}

enum class SegmentKind { kDrive, kTurn, kDwell };

SegmentKind kind_of(const TrajectoryPoint& a, const TrajectoryPoint& b, double length) {
  if (length > kNoLengthM) return SegmentKind::kDrive;
  if (std::abs(maps::wrap_angle(b.pose.phi - a.pose.phi)) > kNoTurnRad) return SegmentKind::kTurn;
  return SegmentKind::kDwell;
}

}  // namespace

TrajectoryLegs::TrajectoryLegs(planning::Trajectory trajectory)
    : trajectory_(std::move(trajectory)) {
  require_usable(trajectory_);
  const auto& points = trajectory_.points;
  arc_m_.assign(points.size(), 0.0);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double length =
        maps::distance(maps::position_of(points[i - 1].pose), maps::position_of(points[i].pose));
    arc_m_[i] = arc_m_[i - 1] + length;
    const SegmentKind kind = kind_of(points[i - 1], points[i], length);
    if (kind == SegmentKind::kDwell) {
      if (!legs_.empty()) legs_.back().last = i;  // a rest belongs to what came before it
      continue;
    }
    const LegKind leg_kind = kind == SegmentKind::kTurn ? LegKind::kTurn : LegKind::kDrive;
    const bool rests_here = std::abs(points[i - 1].speed_m_s) < kAtRestMS;
    const bool continues = !legs_.empty() && legs_.back().kind == leg_kind &&
                           (leg_kind == LegKind::kTurn || !rests_here);
    if (!continues) legs_.push_back({leg_kind, i - 1, i - 1});
    legs_.back().last = i;
  }
}

double TrajectoryLegs::arc_at_time(double time_s) const {
  const auto& points = trajectory_.points;
  if (time_s <= points.front().time_s) return arc_m_.front();
  if (time_s >= points.back().time_s) return arc_m_.back();
  const auto after =
      std::upper_bound(points.begin(), points.end(), time_s,
                       [](double t, const TrajectoryPoint& p) { return t < p.time_s; });
  const auto i = static_cast<std::size_t>(after - points.begin());
  const double span = points[i].time_s - points[i - 1].time_s;
  const double share = span > 0.0 ? (time_s - points[i - 1].time_s) / span : 0.0;
  return arc_m_[i - 1] + share * (arc_m_[i] - arc_m_[i - 1]);
}

PathPlace TrajectoryLegs::on_segment(std::size_t i, double share) const {
  const TrajectoryPoint& a = trajectory_.points[i];
  const TrajectoryPoint& b = trajectory_.points[i + 1];
  const double s = std::clamp(share, 0.0, 1.0);
  PathPlace place;
  place.arc_m = arc_m_[i] + share * (arc_m_[i + 1] - arc_m_[i]);
  place.time_s = a.time_s + s * (b.time_s - a.time_s);
  place.pose = {a.pose.x + s * (b.pose.x - a.pose.x), a.pose.y + s * (b.pose.y - a.pose.y),
                maps::wrap_angle(a.pose.phi + s * maps::wrap_angle(b.pose.phi - a.pose.phi))};
  place.curvature_1_m = a.curvature_1_m + s * (b.curvature_1_m - a.curvature_1_m);
  return place;
}

PathPlace TrajectoryLegs::project(const TPoint2D& point, const Leg& leg, double around_arc_m,
                                  const SearchWindow& window) const {
  const auto& points = trajectory_.points;
  PathPlace best;
  double best_distance = std::numeric_limits<double>::infinity();
  std::size_t first_drivable = leg.last, last_drivable = leg.first;
  for (std::size_t i = leg.first; i < leg.last; ++i) {
    if (arc_m_[i + 1] - arc_m_[i] <= kNoLengthM) continue;
    first_drivable = std::min(first_drivable, i);
    last_drivable = i;
  }
  for (std::size_t i = leg.first; i < leg.last; ++i) {
    const double length = arc_m_[i + 1] - arc_m_[i];
    if (length <= kNoLengthM) continue;
    if (arc_m_[i + 1] < around_arc_m - window.back_m) continue;
    if (arc_m_[i] > around_arc_m + window.ahead_m) break;
    const TPose2D& a = points[i].pose;
    const TPose2D& b = points[i + 1].pose;
    const double ux = (b.x - a.x) / length, uy = (b.y - a.y) / length;
    const double px = point.x - a.x, py = point.y - a.y;
    double share = (px * ux + py * uy) / length;
    if (i != first_drivable) share = std::max(share, 0.0);
    if (i != last_drivable) share = std::min(share, 1.0);
    const double ex = px - share * length * ux, ey = py - share * length * uy;
    const double distance = std::hypot(ex, ey);
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = on_segment(i, share);
    best.cross_track_m = std::copysign(distance, ux * py - uy * px);
  }
  if (!std::isfinite(best_distance)) return at_arc(around_arc_m, leg);
  return best;
}

PathPlace TrajectoryLegs::at_arc(double arc_m, const Leg& leg) const {
  std::size_t i = leg.first;
  while (i + 1 < leg.last && arc_m_[i + 1] < arc_m) ++i;
  const double length = arc_m_[i + 1] - arc_m_[i];
  const double share = length > kNoLengthM ? (arc_m - arc_m_[i]) / length : 0.0;
  PathPlace place = on_segment(i, std::clamp(share, 0.0, 1.0));
  return place;
}

}  // namespace rovigo::control
