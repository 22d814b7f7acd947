#pragma once
// What is known of a rover's motion apart from its gyro and accelerometer, as updates of the
// filter's state: rest, the floor, what the wheels counted, and looks at the world.

#include <array>

#include "slam/inertial_state.h"
#include "slam/planar_information.h"

namespace rovigo::slam {

inline constexpr std::array<int, 3> kPlanarError = {
    InertialState::kPosition, InertialState::kPosition + 1, InertialState::kAttitude + 2};

/// Puts the rover down upright on its floor.
void place_on_floor(const TPose2D& map_from_base, double sigma_position_m, double sigma_heading_rad,
                    InertialState& state);
/// A rover stays on its floor, to within what floors and springs allow. This is one fact, not a
/// new measurement each time: it never makes the pose surer than that.
void hold_to_floor(InertialState& state);
/// It stands: no velocity, no rate, no acceleration, which teaches the biases.
void hold_still(InertialState& state);
/// Wheels that grip neither slide sideways nor leave the floor.
void hold_on_track(InertialState& state);

/// What the wheels counted over `dt`. A surprise means that the speed changed faster than expected;
/// slip has been judged before.
void measure_distance(double counted_m, double dt, InertialState& state);
void measure_wheel_turn(double counted_rad, double dt, InertialState& state);
void forget_wheel_turn(InertialState& state);
void forget_wheel_count(InertialState& state);

/// Takes a look in; `floor_m`, `floor_rad`: errors that all looks share. False: it made no sense.
bool take_look(const PlanarInformation& look, double floor_m, double floor_rad,
               InertialState& state);

}  // namespace rovigo::slam
