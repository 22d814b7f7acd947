#pragma once
// A trajectory cut at its rests: stretches that are driven and turns in place.

#include <vector>

#include "planning/trajectory.h"

namespace rovigo::control {

enum class LegKind { kDrive, kTurn };

/// Points first..last of the trajectory, both included. Neighbouring legs share a point.
struct Leg {
  LegKind kind = LegKind::kDrive;
  std::size_t first = 0;
  std::size_t last = 0;
};

/// A place on the trajectory's geometry.
struct PathPlace {
  double arc_m = 0.0;  ///< along the whole trajectory
  double time_s = 0.0;
  TPose2D pose;  ///< on the path; yaw along it
  double curvature_1_m = 0.0;
  double cross_track_m = 0.0;  ///< of the point asked about; left positive
};

/// How far from a known place the projection looks, metres along the path.
struct SearchWindow {
  double back_m = 0.2;
  double ahead_m = 0.6;
};

/// A trajectory with its arc lengths, cut into legs. Throws InputError for a trajectory that is
/// empty, not finite, or whose times run backwards.
class TrajectoryLegs {
 public:
  explicit TrajectoryLegs(planning::Trajectory trajectory);

  const planning::Trajectory& trajectory() const { return trajectory_; }
  const std::vector<Leg>& legs() const { return legs_; }  ///< empty: the trajectory never moves

  double start_time_s(const Leg& leg) const { return trajectory_.points[leg.first].time_s; }
  double end_time_s(const Leg& leg) const { return trajectory_.points[leg.last].time_s; }
  double end_arc_m(const Leg& leg) const { return arc_m_[leg.last]; }
  double arc_at_time(double time_s) const;

  /// The nearest place to `point` on a driven leg, looked for around `around_arc_m` only, so that
  /// crossings and loops do not catch the rover. The ends are extended straight for the arc's sake:
  /// a point beyond the end has an arc beyond it.
  PathPlace project(const TPoint2D& point, const Leg& leg, double around_arc_m,
                    const SearchWindow& window) const;
  /// The place at an arc, clamped to the leg.
  PathPlace at_arc(double arc_m, const Leg& leg) const;

 private:
  PathPlace on_segment(std::size_t i, double share) const;

  planning::Trajectory trajectory_;
  std::vector<double> arc_m_;
  std::vector<Leg> legs_;
};

}  // namespace rovigo::control
