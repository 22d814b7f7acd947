#include "control/first_order_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace rovigo::control {
namespace {

constexpr int kTimeConstants = 14, kDeadTimes = 20;  // of the grid
constexpr int kMostIterations = 60, kMostTries = 8;
constexpr double kHuberSigmas = 2.0;

}  // namespace

ResponseBases simulate_bases(const std::vector<IdentificationSample>& rows, double time_constant_s,
                             double dead_time_s) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  ResponseBases out{Eigen::VectorXd(n), Eigen::VectorXd(n)};
  double forced = 0.0, free = 1.0, now = rows.front().time_s;
  double input = rows.front().setpoint;
  std::size_t next = 1;  // row whose set-point arrives next
  const auto advance = [&](double to) {
    const double keep = time_constant_s > 0.0 ? std::exp((now - to) / time_constant_s) : 0.0;
    forced = input + keep * (forced - input);
    free *= keep;
    now = to;
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const double time = rows[static_cast<std::size_t>(i)].time_s;
    for (; next < rows.size() && rows[next].time_s + dead_time_s <= time; ++next) {
      if (rows[next].setpoint == input) continue;
      if (rows[next].time_s + dead_time_s > now) advance(rows[next].time_s + dead_time_s);
      input = rows[next].setpoint;
    }
    if (time > now) advance(time);
    out.forced[i] = forced;
    out.free[i] = free;
  }
  return out;
}

FirstOrderFit::FirstOrderFit(const std::vector<IdentificationSample>& rows, const FitRange& range)
    : rows_(rows), range_(range) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  response_.resize(n);
  weights_ = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double y = rows[static_cast<std::size_t>(i)].response;
    response_[i] = std::isfinite(y) ? y : 0.0;
    weights_[i] = std::isfinite(y) ? 1.0 : 0.0;
  }
  measured_ = weights_;
}

void FirstOrderFit::search_grid() {
  double best = std::numeric_limits<double>::infinity();
  const double low = std::log(range_.least_time_constant_s);
  const double high = std::log(range_.most_time_constant_s);
  for (int i = 0; i < kTimeConstants; ++i) {
    const double log_time_constant = low + (high - low) * i / (kTimeConstants - 1);
    for (int j = 0; j < kDeadTimes; ++j) {
      const double share = static_cast<double>(j) / (kDeadTimes - 1);
      const double dead_time = range_.most_dead_time_s * share * share;  // denser near zero
      const FitParameters p = with_linear_part(log_time_constant, dead_time);
      const double cost = cost_of(residuals(p));
      if (cost < best) {
        best = cost;
        parameters_ = p;
      }
    }
  }
}

void FirstOrderFit::refine() {
  double damping = 1e-3;
  for (int i = 0; i < kMostIterations && improve(damping); ++i) {
  }
}

/// One step; false when none makes it better.
bool FirstOrderFit::improve(double& damping) {
  const Eigen::VectorXd r = residuals(parameters_);
  update_weights(r);
  const double cost = cost_of(r);
  const Eigen::MatrixXd j = jacobian();
  const Eigen::Matrix4d h = j.transpose() * weights_.asDiagonal() * j;
  const Eigen::Vector4d g = j.transpose() * weights_.cwiseProduct(r);
  for (int tries = 0; tries < kMostTries; ++tries) {
    Eigen::Matrix4d damped = h;
    damped.diagonal() += damping * h.diagonal() + Eigen::Vector4d::Constant(1e-15);
    const FitParameters p = bounded(parameters_ + damped.ldlt().solve(g));
    if (p.allFinite() && cost_of(residuals(p)) < cost) {
      const double step = (p - parameters_).cwiseAbs().maxCoeff();
      parameters_ = p;
      damping = std::max(damping / 5.0, 1e-9);
      return step > 1e-10;
    }
    damping *= 5.0;
  }
  return false;
}

Eigen::VectorXd FirstOrderFit::residuals(const FitParameters& p) const {
  const ResponseBases b = simulate_bases(rows_, std::exp(p[1]), p[2]);
  return (response_ - p[0] * b.forced - p[3] * b.free).cwiseProduct(measured_);
}

Eigen::Matrix4d FirstOrderFit::covariance() const {
  const Eigen::VectorXd r = residuals(parameters_);
  const Eigen::MatrixXd j = jacobian();
  const Eigen::Matrix4d h = j.transpose() * weights_.asDiagonal() * j;
  const double freedom = std::max(1.0, weights_.sum() - 4.0);
  // Residuals that hang together count for fewer: (1 + c) / (1 - c) of a first-order process.
  const double hangs = correlation(r);
  const double variance = cost_of(r) / freedom * (1.0 + hangs) / (1.0 - hangs);
  // A parameter that moves nothing must come out as unknown, not as a failed inverse.
  Eigen::Matrix4d safe = h;
  safe.diagonal() += Eigen::Vector4d::Constant(1e-12 * std::max(h.trace(), 1e-300));
  return variance * safe.inverse();
}

double FirstOrderFit::correlation(const Eigen::VectorXd& r) const {
  double same = 0.0, all = 0.0;
  for (Eigen::Index i = 0, last = -1; i < r.size(); ++i) {
    if (measured_[i] == 0.0) continue;
    all += r[i] * r[i];
    if (last >= 0) same += r[i] * r[last];
    last = i;
  }
  return all > 0.0 ? std::clamp(same / all, 0.0, 0.995) : 0.0;
}

FitParameters FirstOrderFit::with_linear_part(double log_time_constant, double dead_time_s) const {
  const ResponseBases b = simulate_bases(rows_, std::exp(log_time_constant), dead_time_s);
  const Eigen::VectorXd wf = weights_.cwiseProduct(b.forced), wr = weights_.cwiseProduct(b.free);
  Eigen::Matrix2d h;
  h << wf.dot(b.forced), wf.dot(b.free), wf.dot(b.free), wr.dot(b.free);
  h.diagonal() += Eigen::Vector2d::Constant(1e-12 * std::max(h.trace(), 1e-300));
  const Eigen::Vector2d x = h.ldlt().solve(Eigen::Vector2d(wf.dot(response_), wr.dot(response_)));
  return {x[0], log_time_constant, dead_time_s, x[1]};
}

Eigen::MatrixXd FirstOrderFit::jacobian() const {
  const FitParameters& p = parameters_;
  Eigen::MatrixXd j(response_.size(), 4);
  const ResponseBases here = simulate_bases(rows_, std::exp(p[1]), p[2]);
  j.col(0) = here.forced;
  j.col(3) = here.free;
  constexpr double kLogStep = 1e-4;
  j.col(1) = (simulated(p, kLogStep, 0.0) - simulated(p, -kLogStep, 0.0)) / (2.0 * kLogStep);
  // Where the dead time is zero there is only one side to look at.
  const double step = std::max(1e-6, 0.05 * range_.sample_step_s);
  const double back = std::min(step, p[2]);
  j.col(2) = (simulated(p, 0.0, step) - simulated(p, 0.0, -back)) / (step + back);
  for (Eigen::Index c = 0; c < 4; ++c) j.col(c) = j.col(c).cwiseProduct(measured_);
  return j;
}

Eigen::VectorXd FirstOrderFit::simulated(const FitParameters& p, double log_step,
                                         double dead_time_step) const {
  const ResponseBases b = simulate_bases(rows_, std::exp(p[1] + log_step), p[2] + dead_time_step);
  return p[0] * b.forced + p[3] * b.free;
}

FitParameters FirstOrderFit::bounded(FitParameters p) const {
  p[1] = std::clamp(p[1], std::log(range_.least_time_constant_s),
                    std::log(range_.most_time_constant_s));
  p[2] = std::clamp(p[2], 0.0, range_.most_dead_time_s);
  return p;
}

void FirstOrderFit::update_weights(const Eigen::VectorXd& r) {
  std::vector<double> sizes;
  for (Eigen::Index i = 0; i < r.size(); ++i)
    if (measured_[i] > 0.0) sizes.push_back(std::abs(r[i]));
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  // The median is 0.6745 sigma of a normal distribution. A perfect half must not leave the other
  // half without a say.
  const double floor = 1e-9 + 0.01 * std::sqrt(r.squaredNorm() / static_cast<double>(r.size()));
  const double limit = kHuberSigmas * std::max(*middle / 0.6745, floor);
  for (Eigen::Index i = 0; i < r.size(); ++i)
    weights_[i] = measured_[i] * std::min(1.0, limit / std::max(std::abs(r[i]), 1e-300));
}

}  // namespace rovigo::control
