#include "app/route_drive.h"

#include <algorithm>
#include <cmath>

#include "maps/error.h"

namespace rovigo::app {

namespace {

constexpr double kTurnAcceleration = 4.0;  // rad/s^2, of turns in place
constexpr double kTurnToleranceRad = 0.02;
constexpr double kRestAfterTurnS = 0.3;
constexpr double kRestAfterKidnapS = 1.0;  // whoever carried it lets go before it drives on
constexpr double kPassedM = 0.35;          // a waypoint this near was visited: paths are smoothed

/// What is driven in one go: places to pass, then a turn in place at the last of them.
struct Leg {
  std::vector<TPoint2D> targets;
  double turn_rad = 0.0;
};

/// One lap's legs, the start excluded unless the lap is not the first.
std::vector<Leg> legs_of(const sim::Route& route, bool first_lap) {
  std::vector<Leg> legs(1);
  auto turn = route.turns.begin();
  for (std::size_t i = 0; i < route.waypoints.size(); ++i) {
    if (i > 0 || !first_lap) legs.back().targets.push_back(route.waypoints[i]);
    if (turn == route.turns.end() || turn->waypoint != i) continue;
    legs.back().turn_rad = turn->turn_rad;
    legs.emplace_back();
    ++turn;
  }
  if (legs.back().targets.empty()) legs.pop_back();
  return legs;
}

planning::PlanResult plan_leg(const planning::Planner& planner, const TPose2D& start,
                              bool heading_given, const std::vector<TPoint2D>& targets) {
  planning::PlanRequest request;
  request.start = start;
  request.start_heading_given = heading_given;
  request.via.assign(targets.begin(), targets.end() - 1);
  request.goal = {targets.back().x, targets.back().y, 0.0};
  return planner.plan(request);
}

/// A lap that ends where it began needs no way back to its first waypoint.
void drop_reached(std::vector<TPoint2D>& targets, const TPoint2D& at) {
  constexpr double kSamePlaceM = 0.05;
  while (!targets.empty() && maps::distance(targets.front(), at) < kSamePlaceM) {
    targets.erase(targets.begin());
  }
}

class RouteDrive {
 public:
  RouteDrive(sim::Simulator& simulator, const sim::Route& route, const planning::Planner& planner,
             const RovigoConfig& config, const DriveHooks& hooks)
      : simulator_(simulator),
        route_(route),
        planner_(planner),
        config_(config),
        hooks_(hooks),
        poses_(true_poses(simulator, TPose2D())),
        loop_(simulator, TPose2D(), *poses_, config, hooks) {}

  RouteDriveResult run(const TPose2D& start) {
    at_ = start;
    loop_.stand_still(kStandBeforeS);
    const int contacts_before = simulator_.truth().contact_events;
    begin_s_ = simulator_.time_s();
    out_.completed = drive_laps();
    loop_.stand_still(kStandAfterS);
    out_.log.contact_events = simulator_.truth().contact_events - contacts_before;
    out_.kidnaps = kidnaps_;
    return std::move(out_);
  }

 private:
  bool drive_laps() {
    for (int lap = 0; lap < route_.laps; ++lap) {
      const auto legs = legs_of(route_, lap == 0);
      for (std::size_t i = 0; i < legs.size(); ++i) {
        from_share_ = (lap + static_cast<double>(i) / static_cast<double>(legs.size())) /
                      static_cast<double>(route_.laps);
        leg_share_ = 1.0 / static_cast<double>(legs.size()) / static_cast<double>(route_.laps);
        if (!drive(legs[i].targets)) return false;
        if (legs[i].turn_rad != 0.0 && !turn(legs[i].turn_rad)) return false;
      }
    }
    return true;
  }

  /// Passes all targets; when the rover is carried away, goes on from there to those left.
  bool drive(std::vector<TPoint2D> targets) {
    drop_reached(targets, maps::position_of(at_));
    while (!targets.empty()) {
      planning::PlanResult plan = plan_leg(planner_, at_, true, targets);
      if (plan.status != planning::PlanStatus::kOk) {
        out_.log.status = control::TrackStatus::kNoProgress;
        out_.message = "no way on from where the rover stood: " + plan.message;
        return false;
      }
      control::TrajectoryTracker tracker(config_.control, config_.robot, plan.trajectory);
      const bool carried = !track(tracker, plan.trajectory.duration_s(), targets);
      at_ = loop_.true_pose();
      if (carried) {
        wait_until_put_down();
        continue;
      }
      if (out_.log.status != control::TrackStatus::kReached) {
        out_.message = control::to_string(out_.log.status);
        return false;
      }
      out_.planned_length_m += plan.path_length_m;
      return true;
    }
    out_.log.status = control::TrackStatus::kReached;
    return true;
  }

  /// False when somebody took the rover away; `targets` then holds what was not yet passed.
  bool track(control::TrajectoryTracker& tracker, double planned_s,
             std::vector<TPoint2D>& targets) {
    const double leg_begin_s = simulator_.time_s();
    out_.log.status = control::TrackStatus::kRunning;
    while (out_.log.status == control::TrackStatus::kRunning) {
      loop_.step(tracker, begin_s_, out_.log);
      loop_.advance(out_.log.steps.back().command);
      if (was_taken()) return false;
      drop_passed(targets);
      if (hooks_.progress && planned_s > 0.0) {
        const double share = (simulator_.time_s() - leg_begin_s) / planned_s;
        hooks_.progress(from_share_ + leg_share_ * std::min(1.0, share));
      }
    }
    return true;
  }

  /// In order, but one may be skipped: a smoothed path can miss a waypoint by more than kPassedM.
  /// The last one is only ever reached by the tracker's word.
  void drop_passed(std::vector<TPoint2D>& targets) const {
    const TPoint2D here = maps::position_of(loop_.true_pose());
    for (std::size_t ahead = 0; ahead < 2 && ahead + 1 < targets.size(); ++ahead) {
      if (maps::distance(targets[ahead], here) > kPassedM) continue;
      targets.erase(targets.begin(), targets.begin() + static_cast<std::ptrdiff_t>(ahead) + 1);
      return;
    }
  }

  bool was_taken() {
    if (simulator_.truth().kidnaps == kidnaps_) return false;
    kidnaps_ = simulator_.truth().kidnaps;
    return true;
  }

  /// Somebody who carries the rover may do so again at once.
  void wait_until_put_down() {
    do {
      while (simulator_.truth().carried) loop_.advance(TTwist2D());
      loop_.stand_still(kRestAfterKidnapS);
    } while (was_taken() || simulator_.truth().carried);
    at_ = loop_.true_pose();
  }

  /// Turns in place at the route's rate. Wheels scrub on the spot, so the command alone would turn
  /// the rover too slowly: its true rate is fed back.
  bool turn(double angle_rad) {
    constexpr double kFeedback = 0.02;  // of the missing rate, each command period
    const double rate = route_.turn_rate_rad_s;
    const double sign = angle_rad < 0.0 ? -1.0 : 1.0;
    const double deadline_s = simulator_.time_s() + 3.0 * std::abs(angle_rad) / rate + 5.0;
    double left_rad = std::abs(angle_rad);
    double wanted = 0.0;
    double trim = 0.0;
    double yaw = loop_.true_pose().phi;
    while (left_rad > kTurnToleranceRad) {
      if (simulator_.time_s() > deadline_s) {
        out_.log.status = control::TrackStatus::kNoProgress;
        out_.message = "a turn in place did not come to its end";
        return false;
      }
      const double braking = std::sqrt(2.0 * kTurnAcceleration * left_rad);
      wanted = std::min({rate, braking, wanted + kTurnAcceleration / 120.0});
      trim += kFeedback * (wanted - sign * simulator_.truth().twist.omega);
      trim = std::clamp(trim, -0.5 * rate, 0.5 * rate);
      log_turn(sign * (wanted + trim));
      loop_.advance(out_.log.steps.back().command);
      if (was_taken()) {
        wait_until_put_down();
        yaw = loop_.true_pose().phi;
        wanted = trim = 0.0;
      }
      const double now_yaw = loop_.true_pose().phi;
      left_rad -= sign * maps::wrap_angle(now_yaw - yaw);
      yaw = now_yaw;
    }
    loop_.stand_still(kRestAfterTurnS);
    at_ = loop_.true_pose();
    return true;
  }

  void log_turn(double omega) {
    control::DriveStep step;
    step.time_s = simulator_.time_s() - begin_s_;
    step.true_pose = step.estimated_pose = loop_.true_pose();
    step.quality = control::PoseQuality::kGood;
    step.command = TTwist2D(0.0, 0.0, omega);
    step.true_twist = simulator_.truth().twist;
    out_.log.steps.push_back(step);
  }

  sim::Simulator& simulator_;
  const sim::Route& route_;
  const planning::Planner& planner_;
  const RovigoConfig& config_;
  const DriveHooks& hooks_;
  std::unique_ptr<PoseSource> poses_;
  DriveLoop loop_;
  TPose2D at_;
  double begin_s_ = 0.0;
  double from_share_ = 0.0;
  double leg_share_ = 1.0;
  int kidnaps_ = 0;
  RouteDriveResult out_;
};

[[noreturn]] void refuse(const sim::Route& route, const sim::World& world,
                         const std::string& message) {
  throw maps::InputError("route \"" + route.name + "\" cannot be driven in world \"" +
                         world.name() + "\": " + message);
}

}  // namespace

maps::OccupancyGrid obstacle_grid(const sim::World& world, const RovigoConfig& config) {
  constexpr double kLowestObstacleM = 0.02;
  constexpr double kHeadroomM = 0.1;
  return sim::true_grid(world, config.slam.grid.grid_resolution_m, kLowestObstacleM,
                        config.robot.body_height_m + kHeadroomM);
}

planning::Planner route_planner(const sim::World& world, const RovigoConfig& config,
                                double speed_m_s) {
  maps::RobotModel robot = config.robot;
  robot.max_speed_m_s = std::min(robot.max_speed_m_s, speed_m_s);
  // Who records keeps well clear of things: the camera sees more, and nothing hurries.
  maps::InflationConfig inflation = config.inflation;
  planning::PlannerConfig planning = config.planning;
  inflation.soft_cost_sigma_m = std::max(inflation.soft_cost_sigma_m, 0.15);
  planning.astar.soft_cost_weight = std::max(planning.astar.soft_cost_weight, 3.0);
  return {obstacle_grid(world, config), robot, inflation, planning};
}

TPose2D route_start(const sim::Route& route, const sim::World& world,
                    const planning::Planner& planner) {
  TPose2D at{route.waypoints[0].x, route.waypoints[0].y, route.start_yaw_rad.value_or(0.0)};
  TPose2D start = at;
  bool heading_given = route.start_yaw_rad.has_value();
  for (int lap = 0; lap < std::min(route.laps, 2); ++lap) {
    for (auto& leg : legs_of(route, lap == 0)) {
      drop_reached(leg.targets, maps::position_of(at));
      if (leg.targets.empty()) continue;
      const auto plan = plan_leg(planner, at, heading_given, leg.targets);
      if (plan.status != planning::PlanStatus::kOk) refuse(route, world, plan.message);
      if (!heading_given) start = plan.trajectory.points.front().pose;
      heading_given = true;
      at = plan.trajectory.points.back().pose;
    }
  }
  return start;
}

RouteDriveResult drive_route(sim::Simulator& simulator, const sim::Route& route,
                             const TPose2D& start, const planning::Planner& planner,
                             const RovigoConfig& config, const DriveHooks& hooks) {
  return RouteDrive(simulator, route, planner, config, hooks).run(start);
}

}  // namespace rovigo::app
