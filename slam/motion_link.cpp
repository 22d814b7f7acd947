#include "slam/motion_link.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

// White noise is stated for readings at about these intervals.
constexpr double kWheelReadingS = 0.02, kGyroReadingS = 0.008;
constexpr double kLateralShare = 0.02;  // sideways creep, as a share of the motion
constexpr double kSlipLastsS = 0.3;
constexpr double kSilenceS = 0.1;  // no reading for longer: the motion is not known
constexpr double kSilentSpeedMS = 0.4, kSilentTurnRadS = 1.0;  // what it may have been

MotionStep part_of(const MotionStep& step, double begin_s, double end_s) {
  const double share = (end_s - begin_s) / std::max(1e-9, step.end_s - step.begin_s);
  MotionStep part = step;
  part.begin_s = begin_s;
  part.end_s = end_s;
  part.distance_m *= share;
  part.turn_rad *= share;
  part.turn_rate_change_rad_s *= share;
  return part;
}

}  // namespace

StepNoise noise_of(const MotionStep& step, const DeadReckoningConfig& config) {
  StepNoise out;
  if (step.standing) return out;
  const double dt = step.end_s - step.begin_s;
  const double speed = step.distance_m / std::max(1e-6, dt);
  const double turn_rate = step.turn_rad / std::max(1e-6, dt);
  out.along_m2 = std::pow(config.wheel_speed_sigma_m_s, 2) * dt * kWheelReadingS;
  const double slip = step.slipping ? 0.2 * speed : 0.0;
  out.along_m2 += (slip * slip + std::pow(step.unseen_speed_m_s, 2)) * dt * kSlipLastsS;
  out.across_m2 = std::pow(kLateralShare, 2) * 0.1 *
                  (std::abs(step.distance_m) + 0.05 * std::abs(step.turn_rad));
  const double sigma = step.has_gyro ? config.gyro_sigma_rad_s
                                     : config.wheel_turn_sigma_rad_s + 0.05 * std::abs(turn_rate);
  out.heading_rad2 = sigma * sigma * dt * (step.has_gyro ? kGyroReadingS : kWheelReadingS);
  return out;
}

TPose2D MotionLink::under(const MotionCalibration& other) const {
  const Eigen::Vector3d moved = by_calibration * (other - calibration);
  return {from_from_to.x + moved.x(), from_from_to.y + moved.y(), from_from_to.phi + moved.z()};
}

void MotionLinks::add(const MotionStep& step) {
  if (!(step.end_s > step.begin_s)) return;
  double from_s = step.begin_s;
  while (!marks_.empty() && marks_.front().time_s <= step.end_s) {
    const double at_s = std::max(from_s, marks_.front().time_s);
    integrate(part_of(step, from_s, at_s));
    finish(marks_.front());
    marks_.pop_front();
    from_s = at_s;
  }
  integrate(part_of(step, from_s, step.end_s));
}

void MotionLinks::integrate(const MotionStep& step) {
  const double dt = step.end_s - step.begin_s;
  if (open_.from < 0 || !(dt > 0)) return;
  const double silent_s = reached_s_ > 0 ? step.begin_s - reached_s_ : 0.0;
  if (silent_s > kSilenceS) {
    const double sigma_m = kSilentSpeedMS * silent_s;
    const double sigma_rad = kSilentTurnRadS * silent_s;
    open_.covariance.diagonal() +=
        Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
  }
  const MotionCalibration& c = open_.calibration;
  const double distance = step.distance_m * (1.0 + c(1));
  const double turn = step.standing ? 0.0
                      : step.has_gyro
                          ? step.turn_rad - c(0) * dt + c(3) * step.turn_rate_change_rad_s
                          : step.turn_rad * (1.0 + c(2));
  TPose2D& pose = open_.from_from_to;
  const double mid = pose.phi + 0.5 * turn;
  const double cos = std::cos(mid), sin = std::sin(mid);
  pose = {pose.x + distance * cos, pose.y + distance * sin, pose.phi + turn};

  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f(0, 2) = -distance * sin;
  f(1, 2) = distance * cos;
  open_.by_calibration = f * open_.by_calibration;
  open_.by_calibration(0, 1) += step.distance_m * cos;
  open_.by_calibration(1, 1) += step.distance_m * sin;
  if (!step.standing && step.has_gyro) {
    open_.by_calibration(2, 0) -= dt;
    open_.by_calibration(2, 3) += step.turn_rate_change_rad_s;
  } else if (!step.standing) {
    open_.by_calibration(2, 2) += step.turn_rad;
  }

  const StepNoise noise = noise_of(step, config_);
  open_.covariance = f * open_.covariance * f.transpose();
  open_.covariance(0, 0) += noise.along_m2 * cos * cos + noise.across_m2 * sin * sin;
  open_.covariance(1, 1) += noise.along_m2 * sin * sin + noise.across_m2 * cos * cos;
  open_.covariance(0, 1) += (noise.along_m2 - noise.across_m2) * sin * cos;
  open_.covariance(1, 0) = open_.covariance(0, 1);
  open_.covariance(2, 2) += noise.heading_rad2;
  reached_s_ = step.end_s;
}

void MotionLinks::mark(int keyframe, double time_s, const MotionCalibration& calibration) {
  marks_.push_back({keyframe, time_s, calibration});
}

void MotionLinks::finish(const Mark& mark) {
  if (open_.from >= 0) {
    open_.to = mark.keyframe;
    open_.end_s = mark.time_s;
    links_.push_back(open_);
  }
  open_ = MotionLink{};
  open_.from = mark.keyframe;
  open_.begin_s = reached_s_ = mark.time_s;
  open_.calibration = mark.calibration;
}

void MotionLinks::cut() {
  // Marks that wait belong to what was; none of them may tie itself to what comes.
  marks_.clear();
  open_ = MotionLink{};
}

}  // namespace rovigo::slam
