#pragma once
// What weighs on the rover's wheels and what they stand on: payload, slope, slippery patches.

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "maps/geometry.h"
#include "maps/robot_model.h"
#include "sim/scenario.h"

namespace rovigo::sim {

inline constexpr double kGravityMS2 = 9.81;

/// What a scenario does to the rover's weight and grip.
struct Footing {
  Payload payload;
  Slope slope;
  FloorGrip grip;
  std::uint64_t seed = 0;  ///< of the patches
};

/// Gravity in the world's frame, m/s^2. On a slope it is gravity that is tilted, and the floor
/// stays the plane z = 0: the rover and its sensors cannot tell the two apart.
Eigen::Vector3d gravity_on(const Slope& slope);

/// The body's mass, its centre of mass in base_link, and its moments of inertia about that.
struct MassProperties {
  double mass_kg = 0.0;
  Eigen::Vector3d center_of_mass = Eigen::Vector3d::Zero();
  Eigen::Vector3d inertia = Eigen::Vector3d::Zero();
};

/// The body without its wheels, but with the payload: a box of even density and a point. The
/// products of inertia (a few percent of the moments) are left out.
MassProperties loaded_body(const maps::RobotModel& robot, const Payload& payload);

/// What each wheel presses on the floor, N: front left, front right, rear left, rear right. By
/// statics, for a rover at rest on a level floor, a load to one side shared by front and rear alike
/// (four wheels leave that open); a wheel that would lift off carries nothing.
std::array<double, 4> wheel_loads(const maps::RobotModel& robot, const Payload& payload);

/// Share of the tyres' friction that the floor gives at a point of the world: 1, or less on a
/// patch. Patches are squares of a fixed raster, drawn by the seed.
double grip_at(const FloorGrip& grip, std::uint64_t seed, const TPoint2D& point);

}  // namespace rovigo::sim
