#include "control/relay_experiment.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <vector>

namespace rovigo::control {
namespace {

constexpr double kMostUnevenness = 0.2;  ///< of the periods, plus two steps: a slow sensor jumps
constexpr double kLateShare = 1.0 / 16.0;

/// What the relay did and saw, step by step.
struct Record {
  std::vector<double> input;
  std::vector<double> seen;        ///< the output when the input was chosen
  std::vector<std::size_t> rises;  ///< steps at which the input went up
};

/// One point of the plant's frequency response.
struct Response {
  double frequency_rad_s = 0.0;
  double gain = 0.0;
  double phase_rad = 0.0;  ///< in (-2 pi, 0]
  double amplitude = 0.0;
};

Record run_relay(Plant plant, const RelayConfig& config, std::size_t late_steps) {
  Record out;
  const auto rises_wanted = static_cast<std::size_t>(config.settling_periods + config.periods) + 1;
  const auto most_steps = static_cast<std::size_t>(config.longest_s / config.step_s);
  std::vector<bool> wants_up;  // by step: what a relay that is not late would do
  double output = 0.0;
  bool up = true;
  for (std::size_t i = 0; i < most_steps && out.rises.size() < rises_wanted; ++i) {
    const bool last = wants_up.empty() || wants_up.back();
    wants_up.push_back(last ? output < config.hysteresis : output < -config.hysteresis);
    const bool now_up = i < late_steps || wants_up[i - late_steps];
    if (now_up && !up) out.rises.push_back(i);
    up = now_up;
    out.input.push_back(up ? config.amplitude : -config.amplitude);
    out.seen.push_back(output);
    output = plant(out.input.back());
    if (!std::isfinite(output)) break;
  }
  return out;
}

bool is_even(const std::vector<std::size_t>& rises, std::size_t from) {
  std::size_t shortest = rises[from + 1] - rises[from], longest = shortest;
  for (std::size_t i = from + 1; i + 1 < rises.size(); ++i) {
    shortest = std::min(shortest, rises[i + 1] - rises[i]);
    longest = std::max(longest, rises[i + 1] - rises[i]);
  }
  return static_cast<double>(longest - shortest) <=
         kMostUnevenness * static_cast<double>(shortest) + 2.0;
}

/// First harmonics of input and output over whole periods.
Response measure_response(const Record& record, std::size_t first, std::size_t last,
                          const RelayConfig& config) {
  const auto steps = static_cast<double>(last - first);
  const double turn = 2.0 * std::numbers::pi * config.periods / steps;  // per step
  std::complex<double> input, seen;
  for (std::size_t i = first; i < last; ++i) {
    const auto back = std::polar(1.0, -turn * static_cast<double>(i - first));
    input += record.input[i] * back;
    seen += record.seen[i] * back;
  }
  const std::complex<double> ratio = seen / input;
  Response out;
  out.frequency_rad_s = turn / config.step_s;
  out.gain = std::abs(ratio);
  out.phase_rad = std::arg(ratio);
  if (out.phase_rad > 0.0) out.phase_rad -= 2.0 * std::numbers::pi;
  out.amplitude = 2.0 * std::abs(seen) / steps;
  return out;
}

struct Oscillation {
  RelayStatus status = RelayStatus::kNoOscillation;
  Response response;
  double period_steps = 0.0;
};

Oscillation oscillate(Plant plant, const RelayConfig& config, std::size_t late_steps) {
  const Record record = run_relay(std::move(plant), config, late_steps);
  const auto settled = static_cast<std::size_t>(config.settling_periods);
  Oscillation out;
  if (record.rises.size() < settled + static_cast<std::size_t>(config.periods) + 1) return out;
  out.status = RelayStatus::kUneven;
  if (!is_even(record.rises, settled)) return out;
  out.status = RelayStatus::kOk;
  const std::size_t first = record.rises[settled], last = record.rises.back();
  out.response = measure_response(record, first, last, config);
  out.period_steps = static_cast<double>(last - first) / config.periods;
  return out;
}

/// Where the line through both points has phase -pi; the first point where there is no line.
Response ultimate_point(const Response& a, const Response& b) {
  Response out = a;
  const double bend = b.phase_rad - a.phase_rad;
  if (std::abs(bend) < 1e-6) return out;
  const double share = (-std::numbers::pi - a.phase_rad) / bend;
  out.frequency_rad_s *= std::pow(b.frequency_rad_s / a.frequency_rad_s, share);
  out.gain *= std::pow(b.gain / a.gain, share);
  out.phase_rad = -std::numbers::pi;
  return out;
}

}  // namespace

RelayResult relay_experiment(const std::function<Plant()>& fresh_plant, const RelayConfig& config) {
  RelayResult out;
  const Oscillation prompt = oscillate(fresh_plant(), config, 0);
  out.status = prompt.status;
  if (out.status != RelayStatus::kOk) return out;
  const auto late_steps =
      static_cast<std::size_t>(std::max(1.0, std::round(kLateShare * prompt.period_steps)));
  const Oscillation late = oscillate(fresh_plant(), config, late_steps);
  out.status = late.status;
  if (out.status != RelayStatus::kOk) return out;

  const Response ultimate = ultimate_point(prompt.response, late.response);
  out.ultimate_gain = 1.0 / ultimate.gain;
  out.ultimate_period_s = 2.0 * std::numbers::pi / ultimate.frequency_rad_s;
  out.output_amplitude = prompt.response.amplitude;
  return out;
}

PidGains ziegler_nichols(ZieglerNicholsRow row, double ultimate_gain, double ultimate_period_s) {
  PidGains gains;
  switch (row) {
    case ZieglerNicholsRow::kP:
      gains.kp = ultimate_gain / 2.0;
      break;
    case ZieglerNicholsRow::kPi:
      gains.kp = ultimate_gain / 2.2;
      gains.ki = gains.kp / (ultimate_period_s / 1.2);
      break;
    case ZieglerNicholsRow::kPid:
      gains.kp = ultimate_gain / 1.7;
      gains.ki = gains.kp / (ultimate_period_s / 2.0);
      gains.kd = gains.kp * ultimate_period_s / 8.0;
      break;
  }
  return gains;
}

}  // namespace rovigo::control
