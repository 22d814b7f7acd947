#pragma once
// Somebody carries the rover away: where it may be put down, and what the ride feels like.

#include <optional>
#include <vector>

#include "maps/distance_field.h"
#include "maps/robot_model.h"
#include "sim/rover.h"
#include "sim/scenario.h"
#include "sim/world.h"

namespace rovigo::sim {

/// Where the rover has been, thinned out; "driven" kidnaps end near it.
class DrivenTrack {
 public:
  void add(const TPose2D& world_from_base);
  const std::vector<TPose2D>& poses() const { return poses_; }

 private:
  std::vector<TPose2D> poses_;
};

/// Free ground of a world where a rover can stand, turn, and drive on from.
class PutDownSpots {
 public:
  PutDownSpots(const World& world, const maps::RobotModel& robot);

  /// The asked pose itself where it will do, else the best spot that can be driven to from `from`;
  /// `from`, turned, where there is none at all.
  TPose2D choose(const TPose2D& from, const Kidnap& kidnap, const DrivenTrack& track) const;

 private:
  /// Cells that can be driven to from the free cell nearest to `from`, and are roomy.
  std::vector<maps::Cell> spots_around(const TPoint2D& from) const;
  bool stands_at(maps::Cell c, double clearance_m) const;

  maps::OccupancyGrid grid_;
  maps::DistanceField field_;
  double radius_m_;
};

/// One way through the air: lifted, carried over smoothly, a little shaken, put down.
class Ride {
 public:
  /// `twist` is what the rover did when it was taken, in the world's axes.
  Ride(const TPose2D& from, const TTwist2D& twist, const TPose2D& to, const Kidnap& kidnap,
       double begin_s);

  bool is_over(double time_s) const { return time_s >= begin_s_ + duration_s_; }
  /// What the body does at that time.
  BodyState at(double time_s) const;
  const TPose2D& target() const { return to_; }
  const std::string& kind() const { return kind_; }
  bool camera_covered() const { return covered_; }

 private:
  Eigen::Isometry3d pose(double time_s) const;

  TPose2D from_;
  TTwist2D twist_;
  TPose2D to_;
  double turn_rad_;
  double begin_s_;
  double duration_s_;
  std::string kind_;
  bool covered_;
};

}  // namespace rovigo::sim
