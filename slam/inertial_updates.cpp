#include "slam/inertial_updates.h"

#include <Eigen/LU>
#include <cmath>

#include "maps/geometry.h"

namespace rovigo::slam {

namespace {

using S = InertialState;
using Term = InertialState::Term;

constexpr double kSurprise = 9.0;  // squared sigmas
constexpr double kFloorHeightSigmaM = 0.005, kFloorTiltSigmaRad = 0.01;
constexpr double kSidewaysSigmaMS = 0.01;
constexpr double kCountSigmaM = 3e-4, kCountSigmaRad = 1.2e-3;  // a tick of the encoders
constexpr double kStillSigmaMS = 1e-4, kStillSigmaRadS = 1e-4, kStillSigmaMS2 = 1e-3;

double squared(double x) { return x * x; }

void measure_count(int counter, int speed, double innovation, double dt, double sigma,
                   InertialState& state) {
  const double variance = squared(sigma);
  const std::array<Term, 1> count = {{{counter, 1.0}}};
  if (squared(innovation) > kSurprise * state.innovation_variance(count, variance)) {
    state.add_doubt(speed, squared(innovation / dt), 0.5 * dt);
  }
  state.update(count, innovation, variance);
}

}  // namespace

void place_on_floor(const TPose2D& map_from_base, double sigma_position_m, double sigma_heading_rad,
                    InertialState& state) {
  state.map_from_base = from_planar(map_from_base);
  for (int i = 0; i < 2; ++i) {
    state.reset_error(S::kPosition + i, squared(sigma_position_m));
    state.reset_error(S::kAttitude + i, squared(kFloorTiltSigmaRad));
  }
  state.reset_error(S::kPosition + 2, squared(kFloorHeightSigmaM));
  state.reset_error(S::kAttitude + 2, squared(sigma_heading_rad));
}

void hold_to_floor(InertialState& state) {
  const auto hold = [&state](int index, double off, double sigma) {
    const double prior = state.covariance(index, index), target = sigma * sigma;
    if (prior <= target * (1.0 + 1e-6)) return;
    const std::array<Term, 1> term = {{{index, 1.0}}};
    state.update(term, -off, prior * target / (prior - target));
  };
  const auto tilt = [&state]() {
    const Se3 upright = from_planar(to_planar(state.map_from_base));
    return so3_log(upright.rotation.transpose() * state.map_from_base.rotation);
  };
  hold(S::kPosition + 2, state.map_from_base.translation.z(), kFloorHeightSigmaM);
  hold(S::kAttitude, tilt().x(), kFloorTiltSigmaRad);
  hold(S::kAttitude + 1, tilt().y(), kFloorTiltSigmaRad);
}

void hold_still(InertialState& state) {
  for (int i = 0; i < 3; ++i) {
    const std::array<Term, 1> velocity = {{{S::kVelocity + i, 1.0}}};
    const std::array<Term, 1> rate = {{{S::kRate + i, 1.0}}};
    const std::array<Term, 1> acceleration = {{{S::kAcceleration + i, 1.0}}};
    state.update(velocity, -state.velocity(i), squared(kStillSigmaMS));
    state.update(rate, -state.rate(i), squared(kStillSigmaRadS));
    state.update(acceleration, -state.acceleration(i), squared(kStillSigmaMS2));
  }
}

void hold_on_track(InertialState& state) {
  for (const int i : {1, 2}) {
    const std::array<Term, 1> sideways = {{{S::kVelocity + i, 1.0}}};
    state.update(sideways, -state.velocity(i), squared(kSidewaysSigmaMS));
  }
}

void measure_distance(double counted_m, double dt, InertialState& state) {
  measure_count(S::kOdometer, S::kVelocity, counted_m - state.odometer_m, dt, kCountSigmaM, state);
  state.odometer_m -= counted_m;
}

void measure_wheel_turn(double counted_rad, double dt, InertialState& state) {
  measure_count(S::kWheelTurn, S::kRate + 2, counted_rad - state.wheel_turn_rad, dt, kCountSigmaRad,
                state);
  state.wheel_turn_rad -= counted_rad;
}

void forget_wheel_turn(InertialState& state) {
  state.wheel_turn_rad = 0.0;
  state.reset_error(S::kWheelTurn, squared(kCountSigmaRad));
}

void forget_wheel_count(InertialState& state) {
  state.odometer_m = 0.0;
  state.reset_error(S::kOdometer, squared(kCountSigmaM));
  forget_wheel_turn(state);
}

bool take_look(const PlanarInformation& look, double floor_m, double floor_rad,
               InertialState& state) {
  const Eigen::Vector3d floor_variance(squared(floor_m), squared(floor_m), squared(floor_rad));
  // (H^-1 + F)^-1 without inverting H, which may be singular.
  const Eigen::Matrix3d shrink =
      (Eigen::Matrix3d::Identity() + look.information * floor_variance.asDiagonal()).inverse();
  Eigen::Matrix3d h = shrink * look.information;
  h = 0.5 * (h + h.transpose()).eval();
  const Eigen::Vector3d g = shrink * look.gradient;
  const TPose2D pose = to_planar(state.map_from_base);
  const Eigen::Vector3d away(look.map_from_base.x - pose.x, look.map_from_base.y - pose.y,
                             maps::wrap_angle(look.map_from_base.phi - pose.phi));
  // Information form of the Kalman gain: valid for singular covariance and information alike.
  auto& p = state.covariance;
  const Eigen::Matrix<double, S::kSize, 3> columns = p(Eigen::all, kPlanarError);
  const Eigen::Matrix3d planar = p(kPlanarError, kPlanarError);
  const Eigen::Matrix<double, S::kSize, 3> gain =
      columns * (Eigen::Matrix3d::Identity() + h * planar).inverse();
  const S::Vector error = gain * (h * away - g);
  if (!error.allFinite() || !gain.allFinite()) return false;
  state.inject(error);
  state.map_from_base = normalized(state.map_from_base);
  p -= gain * h * columns.transpose();
  p = 0.5 * (p + p.transpose()).eval();
  return true;
}

}  // namespace rovigo::slam
