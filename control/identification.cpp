#include "control/identification.h"

#include <algorithm>
#include <cmath>

#include "control/first_order_fit.h"

namespace rovigo::control {
namespace {

using Log = std::vector<IdentificationSample>;

constexpr std::size_t kLeastSamples = 20;
constexpr double k95 = 1.96;

/// Rows in order of time; what is not finite or goes back in time is left out.
Log usable_rows(const Log& log) {
  Log rows;
  for (const IdentificationSample& s : log) {
    if (!std::isfinite(s.time_s) || !std::isfinite(s.setpoint)) continue;
    if (rows.empty() || s.time_s > rows.back().time_s) rows.push_back(s);
  }
  return rows;
}

std::size_t measured_rows(const Log& rows) {
  return static_cast<std::size_t>(std::count_if(
      rows.begin(), rows.end(), [](const auto& s) { return std::isfinite(s.response); }));
}

bool setpoint_changes(const Log& rows) {
  const auto [low, high] =
      std::minmax_element(rows.begin(), rows.end(),
                          [](const auto& a, const auto& b) { return a.setpoint < b.setpoint; });
  const double size = std::max(std::abs(low->setpoint), std::abs(high->setpoint));
  return high->setpoint - low->setpoint > 1e-9 * size;
}

FitRange range_of(const Log& rows, const IdentificationConfig& config) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < rows.size(); ++i)
    steps.push_back(rows[i].time_s - rows[i - 1].time_s);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double span = rows.back().time_s - rows.front().time_s;
  return {*middle / 5.0, 2.0 * span, std::min(std::max(config.max_dead_time_s, 0.0), span / 4.0),
          *middle};
}

double fit_share(const Log& rows, const Eigen::VectorXd& residuals) {
  double mean = 0.0, n = 0.0, variation = 0.0;
  for (const auto& s : rows) {
    if (!std::isfinite(s.response)) continue;
    mean += s.response;
    n += 1.0;
  }
  mean /= std::max(n, 1.0);
  for (const auto& s : rows)
    if (std::isfinite(s.response)) variation += (s.response - mean) * (s.response - mean);
  return variation > 0.0 ? 1.0 - std::sqrt(residuals.squaredNorm() / variation) : 0.0;
}

ConfidenceInterval around(double value, double sigma) {
  return {value - k95 * sigma, value + k95 * sigma};
}

ConfidenceInterval not_negative(ConfidenceInterval i) {
  i.low = std::max(i.low, 0.0);
  return i;
}

IdentificationStatus judge(const IdentificationResult& r, double lag_sigma_s, double correlation,
                           const FitRange& range) {
  if (!std::isfinite(r.model.gain) || !(r.gain_95.high - r.gain_95.low >= 0.0))
    return IdentificationStatus::kVague;
  if (r.gain_95.low <= 0.0 && r.gain_95.high >= 0.0) return IdentificationStatus::kNoResponse;
  // Noise lowers the fit, too, but leaves nothing that hangs together.
  if (r.fit_share < 0.5 && correlation > 0.6) return IdentificationStatus::kNotFirstOrder;
  // The whole lag is what every log tells best; its split into two is a finer question.
  const double lag = r.model.time_constant_s + r.model.dead_time_s;
  const bool lag_known = k95 * lag_sigma_s < std::max(lag, 2.0 * range.sample_step_s);
  const double half_gain = (r.gain_95.high - r.gain_95.low) / 2.0;
  if (half_gain > 0.5 * std::abs(r.model.gain) || !lag_known) return IdentificationStatus::kVague;
  return IdentificationStatus::kOk;
}

IdentificationResult identify_rows(const Log& rows, const IdentificationConfig& config) {
  IdentificationResult out;
  out.samples = measured_rows(rows);
  if (out.samples < kLeastSamples) return out;
  out.status = IdentificationStatus::kNoExcitation;
  if (!setpoint_changes(rows)) return out;

  const FitRange range = range_of(rows, config);
  FirstOrderFit fit(rows, range);
  fit.search_grid();
  fit.refine();
  const FitParameters& p = fit.parameters();
  const Eigen::VectorXd r = fit.residuals(p);
  const Eigen::Matrix4d c = fit.covariance();
  out.model = {p[0], std::exp(p[1]), p[2]};
  out.initial_response = p[3];
  const double time_constant_sigma = out.model.time_constant_s * std::sqrt(c(1, 1));
  out.gain_95 = around(out.model.gain, std::sqrt(c(0, 0)));
  out.time_constant_95_s = not_negative(around(out.model.time_constant_s, time_constant_sigma));
  out.dead_time_95_s = not_negative(around(out.model.dead_time_s, std::sqrt(c(2, 2))));
  out.fit_share = fit_share(rows, r);
  out.residual_rms = std::sqrt(r.squaredNorm() / static_cast<double>(out.samples));
  const Eigen::Vector4d lag_gradient(0.0, out.model.time_constant_s, 1.0, 0.0);
  const double lag_sigma = std::sqrt(std::max(0.0, lag_gradient.dot(c * lag_gradient)));
  out.status = judge(out, lag_sigma, fit.correlation(r), range);
  return out;
}

/// The first half's model on the second half, which it never saw.
double validate_halves(const Log& rows, const IdentificationConfig& config) {
  const auto middle = rows.begin() + static_cast<std::ptrdiff_t>(rows.size() / 2);
  const Log first(rows.begin(), middle), second(middle, rows.end());
  const IdentificationResult made = identify_rows(first, config);
  if (made.status != IdentificationStatus::kOk || measured_rows(second) < kLeastSamples)
    return std::numeric_limits<double>::quiet_NaN();
  // Simulated from the log's first row, so that nothing of the second half is used.
  const std::vector<double> y = simulate(made.model, rows, made.initial_response);
  Eigen::VectorXd r(static_cast<Eigen::Index>(second.size()));
  for (std::size_t i = 0; i < second.size(); ++i) {
    const double error = second[i].response - y[first.size() + i];
    r[static_cast<Eigen::Index>(i)] = std::isfinite(error) ? error : 0.0;
  }
  return fit_share(second, r);
}

}  // namespace

const char* to_string(IdentificationStatus status) {
  switch (status) {
    case IdentificationStatus::kOk:
      return "ok";
    case IdentificationStatus::kTooFewSamples:
      return "too_few_samples";
    case IdentificationStatus::kNoExcitation:
      return "no_excitation";
    case IdentificationStatus::kNoResponse:
      return "no_response";
    case IdentificationStatus::kVague:
      return "vague";
    case IdentificationStatus::kNotFirstOrder:
      return "not_first_order";
  }
  return "unknown";
}

IdentificationResult identify_first_order(const std::vector<IdentificationSample>& log,
                                          const IdentificationConfig& config) {
  const Log rows = usable_rows(log);
  IdentificationResult out = identify_rows(rows, config);
  if (out.status == IdentificationStatus::kOk)
    out.validation_fit_share = validate_halves(rows, config);
  return out;
}

std::vector<double> simulate(const FirstOrderModel& model,
                             const std::vector<IdentificationSample>& log,
                             double initial_response) {
  if (log.empty()) return {};
  const ResponseBases b = simulate_bases(log, model.time_constant_s, model.dead_time_s);
  const Eigen::VectorXd y = model.gain * b.forced + initial_response * b.free;
  return {y.data(), y.data() + y.size()};
}

}  // namespace rovigo::control
