#include "sim/kidnapping.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "sim/simulator.h"

namespace rovigo::sim {
namespace {

constexpr double kCellM = 0.05;
constexpr double kLowestObstacleM = 0.02;
constexpr double kHeadroomM = 0.1;
constexpr double kPassM = 0.05;   // beyond the rover's radius: what it can drive through
constexpr double kRoomyM = 0.10;  // beyond the rover's radius: where it is put down
constexpr double kNearTrackM = 0.6;

constexpr double kLiftM = 0.5;
constexpr double kShakeRad = 0.07;
constexpr double kShakeHz = 1.3;

}  // namespace

void DrivenTrack::add(const TPose2D& pose) {
  constexpr double kStepM = 0.2;
  constexpr double kStepRad = 0.3;
  if (!poses_.empty()) {
    const TPose2D& last = poses_.back();
    if (maps::distance(maps::position_of(last), maps::position_of(pose)) < kStepM &&
        std::abs(maps::wrap_angle(last.phi - pose.phi)) < kStepRad) {
      return;
    }
  }
  poses_.push_back(pose);
}

PutDownSpots::PutDownSpots(const World& world, const maps::RobotModel& robot)
    : grid_(true_grid(world, kCellM, kLowestObstacleM, robot.body_height_m + kHeadroomM)),
      field_(maps::distance_to_occupied(grid_)),
      radius_m_(robot.robot_radius_m) {}

bool PutDownSpots::stands_at(maps::Cell c, double clearance_m) const {
  return grid_.geometry.contains(c) && maps::OccupancyGrid::is_free(grid_.at(c)) &&
         static_cast<double>(field_.at(c)) >= clearance_m;
}

std::vector<maps::Cell> PutDownSpots::spots_around(const TPoint2D& from) const {
  const auto& g = grid_.geometry;
  const double pass_m = radius_m_ + kPassM;
  maps::Cell start{-1, -1};
  double nearest = std::numeric_limits<double>::infinity();
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      const double d = maps::distance(g.center_of({x, y}), from);
      if (d >= nearest || !stands_at({x, y}, pass_m)) continue;
      nearest = d;
      start = {x, y};
    }
  }
  std::vector<maps::Cell> spots;
  if (!g.contains(start)) return spots;
  std::vector<bool> reached(g.size(), false);
  reached[g.index_of(start)] = true;
  std::deque<maps::Cell> open{start};
  while (!open.empty()) {
    const maps::Cell c = open.front();
    open.pop_front();
    if (stands_at(c, radius_m_ + kRoomyM)) spots.push_back(c);
    for (const auto& d : {maps::Cell{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const maps::Cell n{c.x + d.x, c.y + d.y};
      if (!stands_at(n, pass_m) || reached[g.index_of(n)]) continue;
      reached[g.index_of(n)] = true;
      open.push_back(n);
    }
  }
  return spots;
}

TPose2D PutDownSpots::choose(const TPose2D& from, const Kidnap& kidnap,
                             const DrivenTrack& track) const {
  const double turn = kidnap.turn_deg * maps::kPi / 180.0;
  const TPose2D asked = maps::compose(from, TPose2D(kidnap.forward_m, kidnap.left_m, turn));
  const TPoint2D start = maps::position_of(from);
  const bool on_track = kidnap.where == "driven";
  const auto spots = spots_around(start);
  const maps::Cell asked_cell = grid_.geometry.cell_at(maps::position_of(asked));
  if (!on_track && std::find(spots.begin(), spots.end(), asked_cell) != spots.end()) return asked;

  const double wanted_m = std::hypot(kidnap.forward_m, kidnap.left_m);
  TPose2D best(from.x, from.y, asked.phi);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& spot : spots) {
    const TPoint2D p = grid_.geometry.center_of(spot);
    const double off_m = std::abs(maps::distance(p, start) - wanted_m);
    double cost = 2.0 * off_m + 0.5 * maps::distance(p, maps::position_of(asked));
    if (on_track) {
      // Known ground, best where the camera has looked that way before.
      double unfamiliar = std::numeric_limits<double>::infinity();
      for (const auto& been : track.poses()) {
        const double away_m = maps::distance(p, maps::position_of(been));
        if (away_m > kNearTrackM) continue;
        unfamiliar =
            std::min(unfamiliar, away_m + std::abs(maps::wrap_angle(been.phi - asked.phi)));
      }
      cost = 2.0 * off_m + unfamiliar;
    }
    if (cost >= least) continue;
    least = cost;
    best = {p.x, p.y, asked.phi};
  }
  return best;
}

Ride::Ride(const TPose2D& from, const TTwist2D& twist, const TPose2D& to, const Kidnap& kidnap,
           double begin_s)
    : from_(from),
      twist_(twist),
      to_(to),
      turn_rad_(kidnap.turn_deg * maps::kPi / 180.0),
      begin_s_(begin_s),
      duration_s_(kidnap.carry_s),
      kind_(kidnap.kind),
      covered_(kidnap.camera == "covered") {}

Eigen::Isometry3d Ride::pose(double time_s) const {
  const double share = std::clamp((time_s - begin_s_) / duration_s_, 0.0, 1.0);
  // Minimum jerk (Flash & Hogan 1985): how hands move things.
  const double s = share * share * share * (10.0 + share * (-15.0 + 6.0 * share));
  const double up = std::sin(maps::kPi * share) * std::sin(maps::kPi * share);
  const double shake = kShakeRad * up;
  const double phase = 2.0 * maps::kPi * kShakeHz * (time_s - begin_s_);
  Eigen::Isometry3d m = Eigen::Isometry3d::Identity();
  // A rover that is taken while it drives does not stop at once.
  const double still = 1.0 - share;
  const double glide_s = (time_s - begin_s_) * still * still * still;
  m.translation() << from_.x + s * (to_.x - from_.x) + glide_s * twist_.vx,
      from_.y + s * (to_.y - from_.y) + glide_s * twist_.vy, kLiftM * up;
  m.linear() = (Eigen::AngleAxisd(from_.phi + s * turn_rad_ + glide_s * twist_.omega,
                                  Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(shake * std::sin(phase), Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(0.7 * shake * std::cos(1.3 * phase), Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  return m;
}

BodyState Ride::at(double time_s) const {
  constexpr double kHalfS = 0.5 * Simulator::kStepS;
  const Eigen::Isometry3d before = pose(time_s - kHalfS);
  const Eigen::Isometry3d after = pose(time_s + kHalfS);
  BodyState s;
  s.world_from_base = pose(time_s);
  s.velocity = (after.translation() - before.translation()) / (2.0 * kHalfS);
  const Eigen::AngleAxisd turned(after.linear() * before.linear().transpose());
  s.angular_velocity = turned.angle() / (2.0 * kHalfS) * turned.axis();
  return s;
}

}  // namespace rovigo::sim
