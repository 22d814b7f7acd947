#pragma once
// A rover for the controller's tests: a unicycle behind a first-order lag, with the faults of a
// real drive, each of which can be switched on alone. No physics, exact and fast.

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <random>
#include <vector>

#include "control/drive_log.h"
#include "control/tracker.h"
#include "maps/robot_model.h"
#include "planning/trajectory.h"

namespace rovigo::control::testing {

struct PlantOptions {
  double lag_s = 0.06;
  double command_delay_s = 0.0;
  double dead_zone_m_s = 0.0;  ///< wheel speeds below it give standstill
  double speed_gain = 1.0;
  double yaw_gain = 1.0;
  double yaw_bias_1_m = 0.0;  ///< pulls to the left: radians per metre driven
};

class Plant {
 public:
  Plant(const PlantOptions& options, const TPose2D& start) : options_(options), pose_(start) {}

  void step(const TTwist2D& command, double dt) {
    pending_.push_back({time_ + options_.command_delay_s, command});
    time_ += dt;
    while (!pending_.empty() && pending_.front().due <= time_ - dt + 1e-9) {
      active_ = pending_.front().command;
      pending_.pop_front();
    }
    constexpr double kHalfTrack = 0.179;
    const double left = stalled(active_.vx - kHalfTrack * active_.omega);
    const double right = stalled(active_.vx + kHalfTrack * active_.omega);
    const double v = options_.speed_gain * (left + right) / 2;
    const double w =
        options_.yaw_gain * (right - left) / (2 * kHalfTrack) + options_.yaw_bias_1_m * twist_.vx;
    const double keep = options_.lag_s > 0 ? std::exp(-dt / options_.lag_s) : 0.0;
    twist_ = {v + keep * (twist_.vx - v), 0.0, w + keep * (twist_.omega - w)};
    const double heading = pose_.phi + twist_.omega * dt / 2;
    pose_ = {pose_.x + twist_.vx * dt * std::cos(heading),
             pose_.y + twist_.vx * dt * std::sin(heading),
             maps::wrap_angle(pose_.phi + twist_.omega * dt)};
  }
  const TPose2D& pose() const { return pose_; }
  const TTwist2D& twist() const { return twist_; }
  double time_s() const { return time_; }
  void put(const TPose2D& pose) { pose_ = pose; }

 private:
  struct Pending {
    double due;
    TTwist2D command;
  };
  double stalled(double wheel) const {
    return std::abs(wheel) < options_.dead_zone_m_s ? 0.0 : wheel;
  }
  PlantOptions options_;
  TPose2D pose_;
  TTwist2D twist_, active_;
  double time_ = 0.0;
  std::deque<Pending> pending_;
};

/// Rest-to-rest pieces under the robot's limits, with curvature as a function of arc length.
class TrajectoryBuilder {
 public:
  TrajectoryBuilder(const maps::RobotModel& robot, const TPose2D& start) : robot_(robot) {
    trajectory_.points.push_back({.time_s = 0.0, .pose = start});
  }
  TrajectoryBuilder& drive(double length, const std::function<double(double)>& curvature) {
    const auto steps = static_cast<std::size_t>(std::ceil(length / 0.004));
    const double ds = length / static_cast<double>(steps);
    std::vector<double> bend(steps + 1), speed(steps + 1);
    std::vector<TPose2D> pose(steps + 1);
    pose[0] = trajectory_.points.back().pose;
    for (std::size_t i = 0; i <= steps; ++i) bend[i] = curvature(static_cast<double>(i) * ds);
    for (std::size_t i = 1; i <= steps; ++i) {
      const double turn = (bend[i - 1] + bend[i]) / 2 * ds;
      const double heading = pose[i - 1].phi + turn / 2;
      pose[i] = {pose[i - 1].x + ds * std::cos(heading), pose[i - 1].y + ds * std::sin(heading),
                 maps::wrap_angle(pose[i - 1].phi + turn)};
    }
    const double a = 0.8 * robot_.max_acceleration_m_s2;
    for (std::size_t i = 0; i <= steps; ++i) {
      const double slope =
          std::abs(bend[std::min(i + 1, steps)] - bend[i > 0 ? i - 1 : 0]) / ds / 2;
      speed[i] = robot_.max_speed_m_s;
      if (bend[i] != 0) {
        speed[i] = std::min(speed[i], 0.8 * robot_.max_yaw_rate_rad_s / std::abs(bend[i]));
      }
      if (slope > 0) {
        speed[i] = std::min(speed[i], std::sqrt(0.5 * robot_.max_yaw_acceleration_rad_s2 / slope));
      }
    }
    speed[0] = speed[steps] = 0.0;
    for (std::size_t i = 1; i <= steps; ++i) {
      speed[i] = std::min(speed[i], std::sqrt(speed[i - 1] * speed[i - 1] + 2 * a * ds));
    }
    for (std::size_t i = steps; i-- > 0;) {
      speed[i] = std::min(speed[i], std::sqrt(speed[i + 1] * speed[i + 1] + 2 * a * ds));
    }
    double t0 = trajectory_.duration_s(), next = t0 + 0.02;
    for (std::size_t i = 0; i < steps; ++i) {
      const double span = 2 * ds / (speed[i] + speed[i + 1]);
      for (; next < t0 + span; next += 0.02) {
        const double tau = next - t0;
        const double acceleration = (speed[i + 1] - speed[i]) / span;
        const double f = (speed[i] * tau + acceleration * tau * tau / 2) / ds;
        push(next, pose[i], pose[i + 1], f, speed[i] + acceleration * tau,
             bend[i] + f * (bend[i + 1] - bend[i]));
      }
      t0 += span;
    }
    push(t0, pose[steps], pose[steps], 1.0, 0.0, bend[steps]);
    return *this;
  }
  TrajectoryBuilder& line(double length) {
    return drive(length, [](double) { return 0.0; });
  }
  TrajectoryBuilder& turn(double angle) {
    const TPose2D from = trajectory_.points.back().pose;
    const double t0 = trajectory_.duration_s();
    const double a = 0.8 * robot_.max_yaw_acceleration_rad_s2;
    const double peak = std::min(0.8 * robot_.max_yaw_rate_rad_s, std::sqrt(std::abs(angle) * a));
    const double ramp = peak / a, total = ramp + std::abs(angle) / peak;
    const int steps = static_cast<int>(std::ceil(total / 0.02));
    for (int i = 1; i <= steps; ++i) {
      const double t = total * i / steps, left = total - t;
      const double done = t < ramp      ? a * t * t / 2
                          : left < ramp ? std::abs(angle) - a * left * left / 2
                                        : peak * (t - ramp / 2);
      const double rate = std::max(0.0, std::min({a * t, a * left, peak}));
      planning::TrajectoryPoint p;
      p.time_s = t0 + t;
      p.pose = {from.x, from.y, maps::wrap_angle(from.phi + std::copysign(done, angle))};
      p.yaw_rate_rad_s = std::copysign(rate, angle);
      trajectory_.points.push_back(p);
    }
    return *this;
  }
  const planning::Trajectory& get() const { return trajectory_; }

 private:
  void push(double t, const TPose2D& a, const TPose2D& b, double f, double v, double bend) {
    planning::TrajectoryPoint p;
    p.time_s = t;
    p.pose = {a.x + f * (b.x - a.x), a.y + f * (b.y - a.y),
              maps::wrap_angle(a.phi + f * maps::wrap_angle(b.phi - a.phi))};
    p.speed_m_s = v;
    p.yaw_rate_rad_s = v * bend;
    p.curvature_1_m = bend;
    trajectory_.points.push_back(p);
  }
  maps::RobotModel robot_;
  planning::Trajectory trajectory_;
};

/// 0 -> 1 -> 0 over a length, with smooth shoulders of `ramp`.
inline double plateau(double s, double length, double ramp) {
  const auto smooth = [](double x) {
    const double c = std::clamp(x, 0.0, 1.0);
    return c * c * (3 - 2 * c);
  };
  return smooth(s / ramp) * smooth((length - s) / ramp);
}

inline planning::Trajectory moderate_curve(const maps::RobotModel& robot) {
  return TrajectoryBuilder(robot, {0, 0, 0})
      .drive(2.0, [](double s) { return 1.2 * std::sin(maps::kPi * s); })
      .get();
}
inline planning::Trajectory figure_of_eight(const maps::RobotModel& robot) {
  constexpr double kLoop = 3.6;
  // the plateau's mean is 1 - ramp / length, so each loop turns by two pi
  const double peak = 2 * maps::kPi / (kLoop - 0.5);
  return TrajectoryBuilder(robot, {0, 0, 0})
      .drive(2 * kLoop,
             [peak](double s) {
               return s < kLoop ? peak * plateau(s, kLoop, 0.5)
                                : -peak * plateau(s - kLoop, kLoop, 0.5);
             })
      .get();
}
inline planning::Trajectory square(const maps::RobotModel& robot) {
  TrajectoryBuilder builder(robot, {0, 0, 0});
  for (int i = 0; i < 4; ++i) builder.line(1.5).turn(maps::kPi / 2);
  return builder.get();
}
inline planning::Trajectory slalom(const maps::RobotModel& robot) {
  return TrajectoryBuilder(robot, {0, 0, 0})
      .drive(4.0, [](double s) { return 1.5 * std::sin(2 * maps::kPi * s / 2.0); })
      .get();
}

struct DriveSetup {
  double step_s = 1.0 / 100;
  double pose_period_s = 1.0 / 30;
  double pose_latency_s = 0.0;
  double position_noise_m = 0.0;
  double yaw_noise_rad = 0.0;
  double sigma_m = 0.0;
  unsigned seed = 1;
  double longest_s = 300.0;
  /// Changes or withholds what the tracker is told: by time.
  std::function<void(double, PoseInput&)> tamper = {};
  /// Called before each plant step.
  std::function<void(double, Plant&)> disturb = {};
};

/// Runs the tracker on the plant until it is done, and half a second longer.
inline DriveLog run_drive(TrajectoryTracker& tracker, Plant& plant, const DriveSetup& setup) {
  DriveLog log;
  std::mt19937_64 random(setup.seed);
  std::normal_distribution<double> normal;
  std::deque<PoseInput> under_way;
  PoseInput newest;
  double next_pose = 0.0, done_at = -1.0;
  for (double t = 0.0; t < setup.longest_s; t = plant.time_s()) {
    if (t >= next_pose - 1e-9) {
      next_pose += setup.pose_period_s;
      PoseInput p;
      p.time_s = t;
      p.map_from_base = plant.pose();
      p.map_from_base.x += setup.position_noise_m * normal(random);
      p.map_from_base.y += setup.position_noise_m * normal(random);
      p.map_from_base.phi += setup.yaw_noise_rad * normal(random);
      p.sigma_position_m = setup.sigma_m;
      p.quality = PoseQuality::kGood;
      under_way.push_back(p);
    }
    while (!under_way.empty() && under_way.front().time_s + setup.pose_latency_s <= t + 1e-9) {
      newest = under_way.front();
      under_way.pop_front();
    }
    PoseInput told = newest;
    if (setup.tamper) setup.tamper(t, told);
    const TrackerOutput out = tracker.step(t, told);
    DriveStep s;
    s.time_s = t;
    s.true_pose = plant.pose();
    s.estimated_pose = told.map_from_base;
    s.quality = told.quality;
    s.sigma_position_m = told.sigma_position_m;
    s.command = out.command;
    s.true_twist = plant.twist();
    s.reference = out.reference;
    s.heading_error_rad = out.heading_error_rad;
    s.cross_track_error_m = out.cross_track_error_m;
    log.steps.push_back(s);
    log.status = out.status;
    if (out.status != TrackStatus::kRunning && done_at < 0) done_at = t;
    if (done_at >= 0 && t > done_at + 0.5) break;
    if (setup.disturb) setup.disturb(t, plant);
    plant.step(out.command, setup.step_s);
  }
  return log;
}

}  // namespace rovigo::control::testing
