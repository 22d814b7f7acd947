#pragma once
// The PI whose integrator is switched on only once, near the target (mission F8).

#include <array>
#include <cstddef>
#include <optional>

namespace rovigo::control {

/// Slope of a signal sampled at an even rate: the means of its oldest and its newest `kWindow`
/// samples in a ring of `kRing`, over the time between the windows' middles. Averaging keeps the
/// noise of a camera out; the price is a delay of half a ring.
class WindowedDerivative {
 public:
  static constexpr std::size_t kRing = 16;
  static constexpr std::size_t kWindow = 5;

  /// Not finite: left out, as if there had been no sample.
  void add(double value);
  /// Per second; nothing before the ring is full.
  std::optional<double> per_second(double sample_time_s) const;
  void reset() { *this = {}; }

 private:
  std::array<double, kRing> ring_{};
  std::size_t next_ = 0;  ///< also the oldest sample's place, once the ring is full
  std::size_t count_ = 0;
};

/// Units of the output per unit of the error, seconds.
struct SwitchingPiConfig {
  double kp = 0.9;
  double ki = 0.3;  ///< per second
  double box_error = 0.2;
  double box_error_rate = 0.1;  ///< per second
  double output_limit = 0.5;
  double sample_time_s = 0.05;  ///< 20 Hz
};

/// output = clamp(kp * error + integral). The integral begins to count when (error, error rate)
/// first lies in the box, and counts from then on. On the way there kp alone drives, usually at the
/// limit, and nothing winds up. Constants: framework thesis, table 4.1.
///
/// It helps where a constant disturbance opposes the approach or is small: the approach by kp
/// alone then comes to rest short of the target, inside the box. It does not where the disturbance
/// assists (the approach enters the box late or moving, and the integral has to change sign), and
/// where it is too large for the box: kp alone stands still at disturbance / kp from the target,
/// and when that is outside the box, the integrator never starts.
class SwitchingPi {
 public:
  explicit SwitchingPi(const SwitchingPiConfig& config) : config_(config) {}

  /// To be called once each `sample_time_s`. A sample that is not finite gives the output of 0.
  double update(double error);
  bool switched_on() const { return on_; }
  double integral() const { return integral_; }

 private:
  SwitchingPiConfig config_;
  WindowedDerivative rate_;
  bool on_ = false;
  double integral_ = 0.0;
};

}  // namespace rovigo::control
