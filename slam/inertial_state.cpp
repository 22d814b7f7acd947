#include "slam/inertial_state.h"

#include <cmath>

namespace rovigo::slam {

namespace {

constexpr double kAccelerationFadeS = 0.3;  // a rover rarely speeds up for longer
// Where nothing measures it, motion reverts to rest but may be anything a rover does.
constexpr double kBlindFadeS = 1.0;
constexpr double kBlindSpeedMS = 0.3, kBlindRateRadS = 0.5;

}  // namespace

void InertialState::derivatives(double dt, bool turn_by_wheels, MovingMatrix& f,
                                MovingByFixed& g) const {
  const Eigen::Matrix3d& r = map_from_base.rotation;
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  const double fade = std::exp(-dt / kAccelerationFadeS);
  f.setIdentity();
  g.setZero();
  f.block<3, 3>(kPosition, kAttitude) = -r * skew(body_velocity()) * dt;
  f.block<3, 3>(kPosition, kVelocity) = r * dt;
  f.block<3, 3>(kPosition, kRate) = -0.5 * dt * dt * r * skew(body_velocity());
  f.block<3, 3>(kPosition, kAcceleration) = 0.5 * dt * dt * r;
  f.block<3, 3>(kAttitude, kAttitude) = so3_exp(-rate * dt);
  f.block<3, 3>(kAttitude, kRate) = dt * identity;
  f.block<3, 3>(kVelocity, kAcceleration) = kAccelerationFadeS * (1.0 - fade) * identity;
  f.block<3, 3>(kAcceleration, kAcceleration) = fade * identity;
  f.col(kVelocity).head<3>() *= 1.0 + speed_scale;
  f.col(kAcceleration).head<3>() *= 1.0 + speed_scale;
  g.col(kSpeedScale - kMoving).head<3>() = r.col(0) * velocity.x() * dt;
  if (turn_by_wheels) {
    f(kAttitude + 2, kRate + 2) *= 1.0 + turn_scale;
    g(kAttitude + 2, kTurnScale - kMoving) = rate.z() * dt;
  }
  f(kOdometer, kVelocity) = dt;
  f(kOdometer, kAcceleration) = 0.5 * dt * dt;
  f(kWheelTurn, kRate + 2) = dt;
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
  add(kGyroDelay, kGyroDelay, noise.delay_walk * noise.delay_walk * dt);
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
  const Eigen::Vector3d along = map_from_base.rotation.col(0);
  covariance.topLeftCorner<3, 3>() += noise.slip_m2 * along * along.transpose();
  covariance.topLeftCorner<3, 3>() += noise.creep_m2 * across * across.transpose();
}

void InertialState::propagate(double dt, const InertialNoise& noise) {
  MovingMatrix f;
  MovingByFixed g;
  derivatives(dt, noise.turn_by_wheels, f, g);
  const double fade = std::exp(-dt / kBlindFadeS);
  const auto revert = [&](int index, double& value, double spread) {
    f.col(index) *= fade;
    value *= fade;
    covariance(index, index) += (1.0 / (fade * fade) - 1.0) * spread * spread;
  };
  for (int i = 0; i < 3; ++i) {
    if (noise.speed_fades) revert(kVelocity + i, velocity(i), kBlindSpeedMS);
    if (i < 2 ? noise.tilting_fades : noise.turn_fades) {
      revert(kRate + i, rate(i), kBlindRateRadS);
    }
  }
  propagate_covariance(f, g);
  add_noise(dt, noise);

  const double held = std::exp(-dt / kAccelerationFadeS);
  const Eigen::Vector3d mean = velocity + 0.5 * dt * acceleration;
  Eigen::Vector3d turn = rate * dt;
  if (noise.turn_by_wheels) turn.z() *= 1.0 + turn_scale;
  map_from_base.translation += map_from_base.rotation * so3_exp(0.5 * turn) * scaled(mean) * dt;
  map_from_base.rotation = map_from_base.rotation * so3_exp(turn);
  odometer_m += mean.x() * dt;
  wheel_turn_rad += rate.z() * dt;
  velocity += kAccelerationFadeS * (1.0 - held) * acceleration;
  acceleration *= held;
}

void InertialState::add_doubt(int index, double variance, double ago_s) {
  Vector effect = Vector::Zero();
  effect(index) = 1.0;
  if (index >= kVelocity && index < kVelocity + 3) {
    effect.segment<3>(kPosition) = ago_s * map_from_base.rotation.col(index - kVelocity);
    if (index == kVelocity) effect(kOdometer) = ago_s;
  } else if (index >= kRate && index < kRate + 3) {
    effect(kAttitude + index - kRate) = ago_s;
    if (index == kRate + 2) effect(kWheelTurn) = ago_s;
  }
  effect *= std::sqrt(variance);
  covariance.noalias() += effect * effect.transpose();
}

/// Adding the rates up gives the heading of one delay ago: since then the body has turned on by
/// rate times delay. Added change by change, so that a heading found otherwise stays as it is.
void InertialState::make_up_delay(double rate_change_rad_s) {
  map_from_base.rotation =
      map_from_base.rotation * so3_exp({0.0, 0.0, gyro_delay_s * rate_change_rad_s});
  const int heading = kAttitude + 2;
  covariance.row(heading) += rate_change_rad_s * covariance.row(kGyroDelay);
  covariance.col(heading) += rate_change_rad_s * covariance.col(kGyroDelay);
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
  Vector error = gain * (innovation / std::sqrt(s));
  error.tail<2>().setZero();
  inject(error);
  const Eigen::Matrix2d scales = covariance.bottomRightCorner<2, 2>();
  covariance.noalias() -= gain * gain.transpose();
  covariance.bottomRightCorner<2, 2>() = scales;
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
  gyro_delay_s += error(kGyroDelay);
  speed_scale += error(kSpeedScale);
  turn_scale += error(kTurnScale);
}

void InertialState::reset_error(int index, double variance) {
  covariance.row(index).setZero();
  covariance.col(index).setZero();
  covariance(index, index) = variance;
}

}  // namespace rovigo::slam
