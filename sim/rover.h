#pragma once
// The rover's body in Bullet: a box on four driven wheels in a world of static solids.

#include <mrpt/math/TTwist2D.h>

#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "maps/geometry.h"
#include "maps/robot_model.h"
#include "sim/footing.h"
#include "sim/world_model.h"

namespace rovigo::sim {

/// What the motors do to the wheels of one side during one step.
struct SideDrive {
  double speed_rad_s = 0.0;
  double torque_limit_nm = 0.0;  ///< of each of the side's two motors
  double friction_nm = 0.0;      ///< of each of its two wheels' gears and bearings
};

/// Where base_link is and how it moves; velocities in the world frame.
struct BodyState {
  Eigen::Isometry3d world_from_base = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of base_link's origin
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();
};

class RoverBody {
 public:
  RoverBody(const WorldModel& world, const maps::RobotModel& robot, const TPose2D& world_from_base,
            const Footing& footing = {});
  ~RoverBody();

  void step(double dt_s, const SideDrive& left, const SideDrive& right);
  BodyState state() const;
  /// Mean speed of a side's wheels about their axles.
  double left_speed_rad_s() const;
  double right_speed_rad_s() const;
  /// Times the rover began to touch anything but the floor.
  int contact_events() const;
  /// What the body touches now; empty: nothing but the floor under the wheels.
  std::string touched() const;
  /// Puts the rover down elsewhere, at rest.
  void place(const TPose2D& world_from_base);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rovigo::sim
