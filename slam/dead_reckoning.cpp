#include "slam/dead_reckoning.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr double kGyroTimeoutS = 0.1;   // an older reading is no reading
constexpr double kWheelTimeoutS = 0.5;  // wheels silent for longer: assumed standing
constexpr double kStandingSpeedMS = 1e-3;
constexpr double kStandingTurnRadS = 0.01;
constexpr double kSlipMemoryS = 0.1;  // smoothing of wheels against gyro
constexpr double kTrackM = 0.358;     // lever of a slipping wheel; nominal is good enough
constexpr double kCarriedRad = 0.15;  // turned so far on standing wheels: carried
constexpr double kMinTurnToCalibrate = 0.15;

}  // namespace

DeadReckoning::DeadReckoning(const DeadReckoningConfig& config) : config_(config) {
  p_(kGyroBias, kGyroBias) = std::pow(config.gyro_bias_sigma_rad_s, 2);
  p_(kSpeedScale, kSpeedScale) = std::pow(config.wheel_speed_scale_sigma, 2);
  p_(kTurnScale, kTurnScale) = std::pow(config.wheel_turn_scale_sigma, 2);
}

void DeadReckoning::place(const TPose2D& map_from_base, double sigma_position_m,
                          double sigma_heading_rad) {
  carried_ = false;
  x_.head<3>() << map_from_base.x, map_from_base.y, map_from_base.phi;
  p_.topRows<3>().setZero();
  p_.leftCols<3>().setZero();
  p_(kX, kX) = p_(kY, kY) = sigma_position_m * sigma_position_m;
  p_(kYaw, kYaw) = sigma_heading_rad * sigma_heading_rad;
}

double DeadReckoning::turn_rate() const {
  if (standing_) return 0.0;
  if (gyro_rate_) return *gyro_rate_ - x_(kGyroBias);
  return wheel_turn_rate_ * (1.0 + x_(kTurnScale));
}

TTwist2D DeadReckoning::twist() const {
  return {wheel_speed_ * (1.0 + x_(kSpeedScale)), 0.0, turn_rate()};
}

void DeadReckoning::move_along_heading(double distance_m) {
  x_(kX) += distance_m * std::cos(x_(kYaw));
  x_(kY) += distance_m * std::sin(x_(kYaw));
}

void DeadReckoning::advance_to(double time_s) {
  if (!started_) {
    time_s_ = time_s;
    started_ = true;
    return;
  }
  if (time_s <= time_s_) return;
  if (gyro_time_s_ && time_s - *gyro_time_s_ > kGyroTimeoutS) gyro_rate_.reset();
  if (odometry_ && time_s - odometry_time_s_ > kWheelTimeoutS) {
    wheel_speed_ = wheel_turn_rate_ = 0.0;
  }
  // Short steps, so that the linearisation holds across a gap in the data.
  constexpr double kLongestStepS = 0.02;
  const int steps =
      std::clamp(static_cast<int>(std::ceil((time_s - time_s_) / kLongestStepS)), 1, 100000);
  const double dt = (time_s - time_s_) / steps;
  for (int i = 0; i < steps; ++i) propagate(dt);
  time_s_ = time_s;
}

void DeadReckoning::propagate(double dt) {
  const double omega = turn_rate();
  const double distance = wheel_speed_ * (1.0 + x_(kSpeedScale)) * dt;
  const double mid = x_(kYaw) + 0.5 * omega * dt;
  const double c = std::cos(mid), s = std::sin(mid);
  x_(kX) += distance * c;
  x_(kY) += distance * s;
  x_(kYaw) += omega * dt;
  assumed_distance_m_ += wheel_speed_ * dt;
  assumed_turn_rad_ += wheel_turn_rate_ * dt;
  if (gyro_rate_) {
    gyro_turn_rad_ += (*gyro_rate_ - x_(kGyroBias)) * dt;
    raw_gyro_turn_rad_ += *gyro_rate_ * dt;
  }

  Matrix f = Matrix::Identity();
  f(kX, kYaw) = -distance * s;
  f(kY, kYaw) = distance * c;
  f(kX, kSpeedScale) = wheel_speed_ * dt * c;
  f(kY, kSpeedScale) = wheel_speed_ * dt * s;
  if (!standing_) {
    if (gyro_rate_) {
      f(kYaw, kGyroBias) = -dt;
    } else {
      f(kYaw, kTurnScale) = wheel_turn_rate_ * dt;
    }
  }
  p_ = f * p_ * f.transpose();
  const StepNoise noise = noise_of({.begin_s = time_s_,
                                    .end_s = time_s_ + dt,
                                    .distance_m = distance,
                                    .turn_rad = omega * dt,
                                    .has_gyro = gyro_rate_.has_value(),
                                    .slipping = slipping_,
                                    .standing = standing_},
                                   config_);
  p_(kX, kX) += noise.along_m2 * c * c + noise.across_m2 * s * s;
  p_(kY, kY) += noise.along_m2 * s * s + noise.across_m2 * c * c;
  p_(kX, kY) += (noise.along_m2 - noise.across_m2) * s * c;
  p_(kY, kX) = p_(kX, kY);
  p_(kYaw, kYaw) += noise.heading_rad2;
  p_(kGyroBias, kGyroBias) += std::pow(config_.gyro_bias_walk_rad_s2, 2) * dt;
}

void DeadReckoning::update_scalar(const Vector& h, double innovation, double variance) {
  const Vector ph = p_ * h;
  const double s = h.dot(ph) + variance;
  if (!(s > 0)) return;
  x_ += ph * (innovation / s);
  p_ -= ph * ph.transpose() / s;
  p_ = 0.5 * (p_ + p_.transpose()).eval();
}

void DeadReckoning::add_gyro(double time_s, double yaw_rate_rad_s) {
  if (!std::isfinite(yaw_rate_rad_s)) return;
  const double since = gyro_time_s_ ? time_s - *gyro_time_s_ : 0.0;
  const bool fresh = gyro_rate_ && since > 0 && since < kGyroTimeoutS;
  advance_to(time_s);
  // The interval was run at the old rate; the trapezoid rule asks for the mean of both.
  if (fresh && !standing_) {
    const double correction = 0.5 * (yaw_rate_rad_s - *gyro_rate_) * since;
    x_(kYaw) += correction;
    gyro_turn_rad_ += correction;
    raw_gyro_turn_rad_ += correction;
  }
  gyro_rate_ = yaw_rate_rad_s;
  gyro_time_s_ = time_s;
  if (!standing_) return;
  const double innovation = yaw_rate_rad_s - x_(kGyroBias);
  const double sigma = config_.gyro_sigma_rad_s;
  const double gate = 5.0 * std::sqrt(p_(kGyroBias, kGyroBias) + sigma * sigma);
  if (std::abs(innovation) > gate) {  // turned by something other than its wheels
    standing_ = false;
    return;
  }
  update_scalar(Vector::Unit(kGyroBias), innovation, sigma * sigma);
}

void DeadReckoning::add_wheels(double time_s, const TPose2D& odom_from_base) {
  if (!maps::is_finite(odom_from_base)) return;
  advance_to(time_s);
  const double dt = time_s - odometry_time_s_;
  if (odometry_ && dt > 1e-4 && dt < 2.0) {
    const TPose2D step = maps::compose(maps::inverse(*odometry_), odom_from_base);
    const double along = step.x * std::cos(0.5 * step.phi) + step.y * std::sin(0.5 * step.phi);
    // The interval was run at the old speed; what the wheels say now replaces it.
    double distance = along;
    wheel_turn_rate_ = step.phi / dt;
    judge_slip(wheel_turn_rate_, dt);
    if (slipping_) {
      // One wheel spins faster than the ground passes: follow the other one.
      const double excess = std::abs(disagreement_rad_s_) * 0.5 * kTrackM * dt;
      distance = std::copysign(std::max(0.0, std::abs(along) - excess), along);
    }
    move_along_heading((distance - assumed_distance_m_) * (1.0 + x_(kSpeedScale)));
    if (!gyro_rate_) x_(kYaw) += (step.phi - assumed_turn_rad_) * (1.0 + x_(kTurnScale));
    wheel_speed_ = distance / dt;
    standing_ = std::abs(wheel_speed_) < kStandingSpeedMS &&
                std::abs(wheel_turn_rate_) < kStandingTurnRadS &&
                (!gyro_rate_ || std::abs(*gyro_rate_ - x_(kGyroBias)) < 0.05);
    judge_carrying(along, step.phi);
    step_ = MotionStep{.begin_s = odometry_time_s_,
                       .end_s = time_s,
                       .distance_m = distance,
                       .turn_rad = gyro_rate_ ? raw_gyro_turn_rad_ : step.phi,
                       .has_gyro = gyro_rate_.has_value(),
                       .slipping = slipping_,
                       .standing = standing_};
  }
  odometry_ = odom_from_base;
  odometry_time_s_ = time_s;
  assumed_distance_m_ = assumed_turn_rad_ = gyro_turn_rad_ = raw_gyro_turn_rad_ = 0.0;
}

/// Wheels at rest and a body that turns: it hangs in somebody's hands, or on a turntable.
void DeadReckoning::judge_carrying(double wheel_distance_m, double wheel_turn_rad) {
  const bool wheels_rest = std::abs(wheel_distance_m) < 1e-4 && std::abs(wheel_turn_rad) < 1e-4;
  turned_standing_rad_ =
      wheels_rest && !standing_ && gyro_rate_ ? turned_standing_rad_ + gyro_turn_rad_ : 0.0;
  if (std::abs(turned_standing_rad_) > kCarriedRad) carried_ = true;
}

std::optional<MotionStep> DeadReckoning::take_step() {
  std::optional<MotionStep> out;
  std::swap(out, step_);
  return out;
}

void DeadReckoning::judge_slip(double wheel_turn_rate, double dt) {
  slipping_ = false;
  if (!gyro_rate_ || dt > kGyroTimeoutS) return;
  const double gyro_turn_rate = gyro_turn_rad_ / dt;
  const double apart = wheel_turn_rate * (1.0 + x_(kTurnScale)) - gyro_turn_rate;
  const double blend = 1.0 - std::exp(-dt / kSlipMemoryS);
  disagreement_rad_s_ += blend * (apart - disagreement_rad_s_);
  const double scale_sigma = std::sqrt(p_(kTurnScale, kTurnScale)) + 0.03;
  const double sigma = config_.wheel_turn_sigma_rad_s + scale_sigma * std::abs(wheel_turn_rate);
  slipping_ = std::abs(disagreement_rad_s_) > config_.slip_gate * sigma;
  // A slip begins before the smoothed figure shows it, and must not pass for a wrong scale.
  const bool doubtful = slipping_ || std::abs(apart) > 0.5 * config_.slip_gate * sigma;
  if (doubtful || std::abs(wheel_turn_rate) < kMinTurnToCalibrate) return;
  // Only the scale of the wheels learns from this: scrubbing wheels must not teach the gyro.
  const double h = wheel_turn_rate;
  const double variance = std::pow(config_.wheel_turn_sigma_rad_s + 0.05 * std::abs(h), 2);
  const double gain =
      p_(kTurnScale, kTurnScale) * h / (h * h * p_(kTurnScale, kTurnScale) + variance);
  x_(kTurnScale) -= gain * apart;
  const double keep = 1.0 - gain * h;
  p_.row(kTurnScale) *= keep;
  p_.col(kTurnScale) *= keep;
  p_(kTurnScale, kTurnScale) += gain * gain * variance + 1e-8;
}

void DeadReckoning::correct(const PlanarInformation& look, double floor_m, double floor_rad) {
  Eigen::Vector3d floor_variance(floor_m * floor_m, floor_m * floor_m, floor_rad * floor_rad);
  // (H^-1 + F)^-1 without inverting H, which may be singular.
  const Eigen::Matrix3d shrink =
      (Eigen::Matrix3d::Identity() + look.information * floor_variance.asDiagonal()).inverse();
  Eigen::Matrix3d h = shrink * look.information;
  h = 0.5 * (h + h.transpose()).eval();
  const Eigen::Vector3d g = shrink * look.gradient;
  const Eigen::Vector3d away(look.map_from_base.x - x_(kX), look.map_from_base.y - x_(kY),
                             maps::wrap_angle(look.map_from_base.phi - x_(kYaw)));
  // Information form of the Kalman gain: valid for singular covariance and information alike.
  const Eigen::Matrix3d ppp = p_.topLeftCorner<3, 3>();
  const Eigen::Matrix<double, kSize, 3> gain =
      p_.leftCols<3>() * (Eigen::Matrix3d::Identity() + h * ppp).inverse();
  const Vector dx = gain * (h * away - g);
  if (!dx.allFinite()) return;
  x_ += dx;
  x_(kYaw) = maps::wrap_angle(x_(kYaw));
  p_ -= gain * h * p_.topRows<3>();
  p_ = 0.5 * (p_ + p_.transpose()).eval();
}

void DeadReckoning::shift(const TPose2D& new_map_from_old_map) {
  const TPose2D moved = maps::compose(new_map_from_old_map, map_from_base());
  x_.head<3>() << moved.x, moved.y, moved.phi;
  Matrix r = Matrix::Identity();
  const double c = std::cos(new_map_from_old_map.phi), s = std::sin(new_map_from_old_map.phi);
  r.topLeftCorner<2, 2>() << c, -s, s, c;
  p_ = r * p_ * r.transpose();
}

}  // namespace rovigo::slam
