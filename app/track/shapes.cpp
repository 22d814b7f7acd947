#include "app/track/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "app/resources.h"
#include "app/route_drive.h"
#include "maps/error.h"
#include "planning/timing.h"
#include "sim/random.h"

namespace rovigo::app {

namespace {

constexpr double kPi = maps::kPi;
constexpr double kControlSpacingM = 0.1;

/// Draws curves by their curvature, from the origin along x. Each piece is driven without a stop.
class Turtle {
 public:
  Turtle& drive(double length_m, const std::function<double(double)>& curvature) {
    constexpr int kSubsteps = 20;
    const int n = std::max(2, static_cast<int>(std::ceil(length_m / kControlSpacingM)));
    const double ds = length_m / n / kSubsteps;
    std::vector<TPoint2D> points{maps::position_of(at_)};
    for (int i = 0; i < n * kSubsteps; ++i) {
      const double turn = curvature((i + 0.5) * ds) * ds;
      at_.x += ds * std::cos(at_.phi + turn / 2);
      at_.y += ds * std::sin(at_.phi + turn / 2);
      at_.phi += turn;
      if ((i + 1) % kSubsteps == 0) points.push_back(maps::position_of(at_));
    }
    pieces_.push_back({planning::CubicBSpline::uniform(points)});
    return *this;
  }
  Turtle& line(double length_m) {
    return drive(length_m, [](double) { return 0.0; });
  }
  Turtle& turn(double angle_rad) {
    at_.phi += angle_rad;
    return *this;
  }
  /// After the last piece the rover turns to where the turtle looks.
  planning::TimingProblem take() {
    planning::TimingProblem problem;
    problem.pieces = std::move(pieces_);
    problem.goal_heading_rad = maps::wrap_angle(at_.phi);
    return problem;
  }

 private:
  TPose2D at_;
  std::vector<planning::PathPiece> pieces_;
};

/// A sum of three waves whose phases and lengths are drawn, at most `largest` in size.
std::function<double(double)> random_curvature(std::uint64_t seed, double largest) {
  struct Wave {
    double size, length_m, phase;
  };
  sim::RandomStream random(seed);
  std::array<Wave, 3> waves{};
  double sum = 0.0;
  for (Wave& w : waves) {
    w = {random.uniform(0.2, 1.0), random.uniform(0.8, 4.0), random.uniform(0.0, 2 * kPi)};
    sum += w.size;
  }
  for (Wave& w : waves) w.size *= largest / sum;
  return [waves](double s) {
    double k = 0.0;
    for (const Wave& w : waves) k += w.size * std::sin(2 * kPi * s / w.length_m + w.phase);
    return k;
  };
}

planning::TimingProblem geometry_of(const TrackShape& s) {
  Turtle turtle;
  const auto constant = [](double k) { return [k](double) { return k; }; };
  const auto wave = [&s](double length_m, double phase) {
    return [k = s.curvature_1_m, length_m, phase](double at) {
      return k * std::sin(2 * kPi * at / length_m + phase);
    };
  };
  if (s.shape == "straight") {
    turtle.line(s.length_m);
  } else if (s.shape == "circle") {
    turtle.drive(2 * kPi * s.radius_m, constant(1.0 / s.radius_m));
  } else if (s.shape == "eight") {
    const double loop = 2 * kPi * s.radius_m;
    turtle.drive(2 * loop, [&](double at) { return (at < loop ? 1.0 : -1.0) / s.radius_m; });
  } else if (s.shape == "square") {
    for (int i = 0; i < 4; ++i) turtle.line(s.length_m).turn(kPi / 2);
  } else if (s.shape == "turn") {
    turtle.line(s.length_m).turn(s.angle_deg * kPi / 180.0).line(s.length_m);
  } else if (s.shape == "slalom") {
    turtle.drive(s.length_m, wave(s.wave_m, kPi / 2));  // cosine: it swings about the x axis
  } else if (s.shape == "curve") {
    turtle.drive(s.length_m, wave(s.length_m, 0.0));
  } else {
    turtle.drive(s.length_m, random_curvature(static_cast<std::uint64_t>(s.seed), s.curvature_1_m));
  }
  return turtle.take();
}

PlannedTrack plan_to_goal(const std::string& name, const TrackShape& shape,
                          const RovigoConfig& config) {
  const sim::World world = open_world(shape.world);
  const planning::Planner planner = route_planner(world, config, config.robot.max_speed_m_s);
  planning::PlanRequest request;
  request.start = world.start();
  request.start_heading_given = true;
  request.goal = {shape.goal_x_m, shape.goal_y_m, 0.0};
  planning::PlanResult plan = planner.plan(request);
  if (plan.status != planning::PlanStatus::kOk) {
    throw maps::InputError("trajectory \"" + name + "\" in world \"" + shape.world +
                           "\" cannot be driven: " + plan.message);
  }
  return {world, std::move(plan.trajectory), world.start()};
}

}  // namespace

sim::World empty_hall() {
  constexpr int kCells = 100;
  maps::OccupancyGrid grid({0.5, {-25.0, -25.0}, kCells, kCells}, maps::OccupancyGrid::kFree);
  for (int i = 0; i < kCells; ++i) {
    grid.at({i, 0}) = grid.at({i, kCells - 1}) = maps::OccupancyGrid::kOccupied;
    grid.at({0, i}) = grid.at({kCells - 1, i}) = maps::OccupancyGrid::kOccupied;
  }
  return sim::World::from_grid(grid, 0.5);
}

PlannedTrack plan_track(const std::string& name, const TrackShape& shape,
                        const RovigoConfig& config) {
  PlannedTrack track =
      shape.shape == "goal"
          ? plan_to_goal(name, shape, config)
          : PlannedTrack{
                empty_hall(),
                planning::time_path(geometry_of(shape),
                                    planning::limits_of(config.robot, config.planning.timing),
                                    config.planning.timing),
                {}};
  track.start.phi = maps::wrap_angle(track.start.phi + shape.first_heading_off_deg * kPi / 180.0);
  return track;
}

}  // namespace rovigo::app
