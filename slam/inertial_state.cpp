#include "slam/inertial_state.h"

#include <cmath>

namespace rovigo::slam {

namespace {

constexpr double kAccelerationFadeS = 0.3;  // a rover rarely speeds up for longer
// Where nothing measures it, motion reverts to rest but may be anything a rover does.
constexpr double kBlindFadeS = 1.0;
constexpr double kBlindSpeedMS = 0.3, kBlindRateRadS = 0.5;

}  // namespace

void InertialState::derivatives(double dt, MovingMatrix& f, MovingByFixed& g) const {
  const Eigen::Matrix3d& r = map_from_base.rotation;
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  const double fade = std::exp(-dt / kAccelerationFadeS);
  f.setIdentity();
  g.setZero();
  f.block<3, 3>(kPosition, kAttitude) = -r * skew(velocity) * dt;
  f.block<3, 3>(kPosition, kVelocity) = r * dt;
  f.block<3, 3>(kPosition, kRate) = -0.5 * dt * dt * r * skew(velocity);
  f.block<3, 3>(kPosition, kAcceleration) = 0.5 * dt * dt * r;
  f.block<3, 3>(kAttitude, kAttitude) = so3_exp(-rate * dt);
  f.block<3, 3>(kAttitude, kRate) = dt * identity;
  f.block<3, 3>(kVelocity, kAcceleration) = kAccelerationFadeS * (1.0 - fade) * identity;
  f.block<3, 3>(kAcceleration, kAcceleration) = fade * identity;
  const double per_speed = 1.0 / (1.0 + speed_scale), per_turn = 1.0 / (1.0 + turn_scale);
  f(kOdometer, kVelocity) = dt * per_speed;
  f(kOdometer, kAcceleration) = 0.5 * dt * dt * per_speed;
  f(kWheelTurn, kRate + 2) = dt * per_turn;
  g(kOdometer, kSpeedScale - kMoving) = -velocity.x() * dt * per_speed * per_speed;
  g(kWheelTurn, kTurnScale - kMoving) = -rate.z() * dt * per_turn * per_turn;
}

/// P = [F G; 0 I] P [F G; 0 I]': the biases and scales stay where they are.
void InertialState::propagate_covariance(const MovingMatrix& f, const MovingByFixed& g) {
  constexpr int kFixed = kSize - kMoving;
  const MovingByFixed cross = covariance.topRightCorner<kMoving, kFixed>();
  const MovingByFixed moved = f * cross + g * covariance.bottomRightCorner<kFixed, kFixed>();
  const MovingMatrix fc = f * cross * g.transpose();
  MovingMatrix moving = f * covariance.topLeftCorner<kMoving, kMoving>() * f.transpose() + fc +
                        fc.transpose() +
                        g * covariance.bottomRightCorner<kFixed, kFixed>() * g.transpose();
  covariance.topLeftCorner<kMoving, kMoving>() = 0.5 * (moving + moving.transpose());
  covariance.topRightCorner<kMoving, kFixed>() = moved;
  covariance.bottomLeftCorner<kFixed, kMoving>() = moved.transpose();
}

void InertialState::add_noise(double dt, const InertialNoise& noise) {
  const auto add = [&](int row, int column, double variance) {
    covariance(row, column) += variance;
    if (row != column) covariance(column, row) += variance;
  };
  for (int i = 0; i < 3; ++i) {
    add(kGyroBias + i, kGyroBias + i, noise.gyro_walk_rad_s2 * noise.gyro_walk_rad_s2 * dt);
    add(kAccelerometerBias + i, kAccelerometerBias + i,
        noise.accelerometer_walk * noise.accelerometer_walk * dt);
    if (noise.still) continue;
    const double turning = noise.turning_rad_s2 * noise.turning_rad_s2;
    add(kRate + i, kRate + i, turning * dt);
    add(kAttitude + i, kRate + i, turning * dt * dt / 2);
    add(kAttitude + i, kAttitude + i, turning * dt * dt * dt / 3);
    const double jerk = noise.jerk_m_s3 * noise.jerk_m_s3;
    add(kAcceleration + i, kAcceleration + i, jerk * dt);
    add(kVelocity + i, kAcceleration + i, jerk * dt * dt / 2);
    add(kVelocity + i, kVelocity + i, jerk * dt * dt * dt / 3);
  }
  if (noise.still) return;
  add(kOdometer, kOdometer, noise.odometer_m2);
  add(kWheelTurn, kWheelTurn, noise.wheel_turn_rad2);
  const Eigen::Vector3d across = map_from_base.rotation.col(1);
  covariance.topLeftCorner<3, 3>() += noise.creep_m2 * across * across.transpose();
}

void InertialState::propagate(double dt, const InertialNoise& noise) {
  MovingMatrix f;
  MovingByFixed g;
  derivatives(dt, f, g);
  const double fade = std::exp(-dt / kBlindFadeS);
  const auto revert = [&](int index, Eigen::Vector3d& value, double spread) {
    f.block<3, 3>(index, index) *= fade;
    value *= fade;
    covariance.diagonal().segment<3>(index).array() += (1 - fade * fade) * spread * spread;
  };
  if (noise.speed_fades) revert(kVelocity, velocity, kBlindSpeedMS);
  if (noise.turn_fades) revert(kRate, rate, kBlindRateRadS);
  propagate_covariance(f, g);
  add_noise(dt, noise);

  const double held = std::exp(-dt / kAccelerationFadeS);
  const Eigen::Vector3d mean_velocity = velocity + 0.5 * dt * acceleration;
  map_from_base.translation +=
      map_from_base.rotation * so3_exp(0.5 * dt * rate) * mean_velocity * dt;
  map_from_base.rotation = map_from_base.rotation * so3_exp(rate * dt);
  odometer_m += mean_velocity.x() * dt / (1.0 + speed_scale);
  wheel_turn_rad += rate.z() * dt / (1.0 + turn_scale);
  velocity += kAccelerationFadeS * (1.0 - held) * acceleration;
  acceleration *= held;
}

void InertialState::spread_doubt(double dt) {
  MovingMatrix f;
  MovingByFixed g;
  derivatives(dt, f, g);
  // Only the integrals of velocity and rate: nothing else has happened in the meantime.
  f.block<3, 3>(kPosition, kAttitude).setZero();
  f.block<3, 3>(kAttitude, kAttitude).setIdentity();
  f.block<3, 3>(kVelocity, kAcceleration).setZero();
  f.block<3, 3>(kAcceleration, kAcceleration).setIdentity();
  g.setZero();
  propagate_covariance(f, g);
}

double InertialState::innovation_variance(std::span<const Term> terms, double variance) const {
  for (const Term& a : terms) {
    for (const Term& b : terms) {
      variance += a.derivative * covariance(a.index, b.index) * b.derivative;
    }
  }
  return variance;
}

void InertialState::update(std::span<const Term> terms, double innovation, double variance) {
  Vector column = Vector::Zero();
  for (const Term& t : terms) column += t.derivative * covariance.col(t.index);
  double s = variance;
  for (const Term& t : terms) s += t.derivative * column(t.index);
  if (!(s > 0) || !std::isfinite(innovation)) return;
  const Vector gain = column / std::sqrt(s);  // twice the root: the product stays symmetric
  inject(gain * (innovation / std::sqrt(s)));
  covariance.noalias() -= gain * gain.transpose();
}

void InertialState::inject(const Vector& error) {
  map_from_base.translation += error.segment<3>(kPosition);
  map_from_base.rotation = map_from_base.rotation * so3_exp(error.segment<3>(kAttitude));
  velocity += error.segment<3>(kVelocity);
  rate += error.segment<3>(kRate);
  acceleration += error.segment<3>(kAcceleration);
  odometer_m += error(kOdometer);
  wheel_turn_rad += error(kWheelTurn);
  gyro_bias += error.segment<3>(kGyroBias);
  accelerometer_bias += error.segment<3>(kAccelerometerBias);
  speed_scale += error(kSpeedScale);
  turn_scale += error(kTurnScale);
}

void InertialState::reset_error(int index, double variance) {
  covariance.row(index).setZero();
  covariance.col(index).setZero();
  covariance(index, index) = variance;
}

}  // namespace rovigo::slam
