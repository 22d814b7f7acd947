#include "control/pattern_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace rovigo::control {
namespace {

/// Points of the poll around `center`, in logarithms, within their bounds.
std::vector<Eigen::VectorXd> poll_points(const Eigen::VectorXd& center,
                                         const Eigen::MatrixXd& directions, double step,
                                         const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
  std::vector<Eigen::VectorXd> out;
  for (Eigen::Index i = 0; i < directions.cols(); ++i) {
    for (const double sign : {1.0, -1.0}) {
      const Eigen::VectorXd point =
          (center + sign * step * directions.col(i)).cwiseMax(low).cwiseMin(high);
      if ((point - center).cwiseAbs().maxCoeff() > 1e-3 * step) out.push_back(point);
    }
  }
  return out;
}

Eigen::MatrixXd random_directions(Eigen::Index n, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd m(n, n);
  for (Eigen::Index i = 0; i < n * n; ++i) m.data()[i] = normal(random);
  return Eigen::HouseholderQR<Eigen::MatrixXd>(m).householderQ();
}

std::vector<double> values_of(const Eigen::VectorXd& logarithms) {
  std::vector<double> out;
  for (const double x : logarithms) out.push_back(std::exp(x));
  return out;
}

double comparable(double cost) {
  return std::isnan(cost) ? std::numeric_limits<double>::infinity() : cost;
}

}  // namespace

PatternSearchResult pattern_search(const std::vector<SearchParameter>& parameters,
                                   const BatchCost& cost, const PatternSearchConfig& config) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  Eigen::VectorXd at(n), low(n), high(n);
  PatternSearchResult out;
  for (Eigen::Index i = 0; i < n; ++i) {
    const SearchParameter& p = parameters[static_cast<std::size_t>(i)];
    at[i] = std::log(p.start);
    low[i] = std::log(p.min);
    high[i] = std::log(p.max);
    out.best.push_back(p.start);
  }
  out.start_cost = out.cost = comparable(cost({out.best}).front());
  out.evaluations = 1;

  std::mt19937_64 random(config.seed);
  Eigen::MatrixXd directions = Eigen::MatrixXd::Identity(n, n);
  double step = std::log(config.first_factor);
  while (out.evaluations < config.max_evaluations) {
    auto points = poll_points(at, directions, step, low, high);
    const auto left = static_cast<std::size_t>(config.max_evaluations - out.evaluations);
    if (points.size() > left) points.resize(left);
    std::vector<std::vector<double>> batch;
    for (const auto& p : points) batch.push_back(values_of(p));
    const std::vector<double> costs = batch.empty() ? std::vector<double>{} : cost(batch);
    out.evaluations += static_cast<int>(batch.size());
    bool moved = false;
    for (std::size_t i = 0; i < costs.size(); ++i) {
      if (!(comparable(costs[i]) < out.cost)) continue;
      out.cost = costs[i];
      out.best = batch[i];
      at = points[i];
      moved = true;
    }
    if (!moved) step /= 2.0;
    if (step < std::log(config.last_factor)) {
      out.converged = true;
      break;
    }
    directions = random_directions(n, random);
  }
  return out;
}

}  // namespace rovigo::control
