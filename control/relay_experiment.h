#pragma once
// The relay experiment (Astrom & Hagglund 1984) and the gains that the rover thesis reads from it.

#include <functional>

namespace rovigo::control {

/// Advances a plant by one step under this input and returns its output after it.
using Plant = std::function<double(double input)>;

struct RelayConfig {
  double step_s = 0.01;     ///< of the plant, and of the relay
  double amplitude = 1.0;   ///< of the relay's output, around 0
  double hysteresis = 0.0;  ///< of the output; more than its noise, or the relay chatters
  double longest_s = 120.0;
  int settling_periods = 4;  ///< left out
  int periods = 8;           ///< averaged
};

enum class RelayStatus {
  kOk,
  kNoOscillation,  ///< too few switches in the time: the plant does not answer, or very slowly
  kUneven,         ///< the periods differ: noise above the hysteresis, or a limit is in the way
};

/// What a proportional controller would need to oscillate for ever, and how it would.
struct RelayResult {
  RelayStatus status = RelayStatus::kNoOscillation;
  double ultimate_gain = 0.0;      ///< input per output
  double ultimate_period_s = 0.0;  ///< both 0 unless ok
  double output_amplitude = 0.0;   ///< of the first experiment's first harmonic
};

/// Drives a fresh plant with a relay on its output, twice, the second time switching a sixteenth of
/// a period late, and measures gain and phase at both oscillations by their first harmonics. The
/// ultimate point, phase -pi, lies on the line through both (phase and log gain over log
/// frequency); so neither the harmonics nor a hysteresis bend the result as they bend the
/// describing function's. The controller is taken to see an output one step after its input.
RelayResult relay_experiment(const std::function<Plant()>& fresh_plant, const RelayConfig& config);

/// u = kp * e + ki * integral of e + kd * derivative of e.
struct PidGains {
  double kp = 0.0;
  double ki = 0.0;  ///< per second
  double kd = 0.0;  ///< seconds
};
enum class ZieglerNicholsRow { kP, kPi, kPid };

/// The rover thesis's table: P Ku/2; PI Ku/2.2, Tu/1.2; PID Ku/1.7, Tu/2, Tu/8.
PidGains ziegler_nichols(ZieglerNicholsRow row, double ultimate_gain, double ultimate_period_s);

}  // namespace rovigo::control
