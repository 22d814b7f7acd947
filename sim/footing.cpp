#include "sim/footing.h"

#include <algorithm>
#include <cmath>

#include "sim/random.h"

namespace rovigo::sim {
namespace {

/// A point mass's moments of inertia about the axes through a centre `arm` away.
Eigen::Vector3d moments_of_point(double mass_kg, const Eigen::Vector3d& arm) {
  return mass_kg * (Eigen::Vector3d::Constant(arm.squaredNorm()) - arm.cwiseAbs2());
}

}  // namespace

Eigen::Vector3d gravity_on(const Slope& slope) {
  const double angle = slope.angle_deg * maps::kPi / 180.0;
  const double uphill = slope.uphill_deg * maps::kPi / 180.0;
  const double along = -kGravityMS2 * std::sin(angle);
  return {along * std::cos(uphill), along * std::sin(uphill), -kGravityMS2 * std::cos(angle)};
}

MassProperties loaded_body(const maps::RobotModel& robot, const Payload& payload) {
  const double empty_kg = robot.mass_kg - 4.0 * robot.wheel_mass_kg;
  const Eigen::Vector3d empty_center(0.0, 0.0, robot.center_of_mass_height_m);
  const Eigen::Vector3d load_center(payload.forward_m, payload.left_m, payload.up_m);
  MassProperties out;
  out.mass_kg = empty_kg + payload.mass_kg;
  out.center_of_mass =
      (empty_kg * empty_center + payload.mass_kg * load_center) / std::max(out.mass_kg, 1e-9);
  const Eigen::Vector3d box(robot.footprint_length_m, robot.footprint_width_m,
                            robot.body_height_m - robot.ground_clearance_m);
  const Eigen::Vector3d empty_inertia =
      empty_kg / 12.0 * (Eigen::Vector3d::Constant(box.squaredNorm()) - box.cwiseAbs2());
  out.inertia = empty_inertia + moments_of_point(empty_kg, empty_center - out.center_of_mass) +
                moments_of_point(payload.mass_kg, load_center - out.center_of_mass);
  return out;
}

std::array<double, 4> wheel_loads(const maps::RobotModel& robot, const Payload& payload) {
  const double mass = robot.mass_kg + payload.mass_kg;
  const double ahead = payload.mass_kg * payload.forward_m / mass;  // of the common centre of mass
  const double left = payload.mass_kg * payload.left_m / mass;
  const double pitch = robot.wheel_base_m > 0.0 ? 2.0 * ahead / robot.wheel_base_m : 0.0;
  const double roll = 2.0 * left / robot.track_width_m;
  const auto load = [&](double x, double y) {
    return std::max(0.0, mass * kGravityMS2 / 4.0 * (1.0 + x * pitch) * (1.0 + y * roll));
  };
  return {load(1, 1), load(1, -1), load(-1, 1), load(-1, -1)};
}

double grip_at(const FloorGrip& grip, std::uint64_t seed, const TPoint2D& point) {
  if (grip.slippery_share <= 0.0) return 1.0;
  const auto column = static_cast<std::int64_t>(std::floor(point.x / grip.patch_m));
  const auto row = static_cast<std::int64_t>(std::floor(point.y / grip.patch_m));
  const std::uint64_t bits = derive_seed(derive_seed(seed, static_cast<std::uint64_t>(column)),
                                         static_cast<std::uint64_t>(row));
  return unit_interval(bits) < grip.slippery_share ? grip.slippery_grip : 1.0;
}

}  // namespace rovigo::sim
