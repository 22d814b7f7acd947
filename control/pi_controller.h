#pragma once
// A PI controller that survives saturation and uneven time steps.

namespace rovigo::control {

struct PiGains {
  double kp = 1.0;
  double ki = 0.0;                  ///< per second
  double anti_windup_time_s = 0.5;  ///< time constant of the back-calculation; > 0
};

struct PiInput {
  double error = 0.0;
  double feed_forward = 0.0;
  double dt_s = 0.0;  ///< measured; <= 0 or not finite: nothing is integrated; long ones are cut
  double min = -1.0;  ///< output limits
  double max = 1.0;
  double integral_limit = 1.0;  ///< largest size of the integral's share of the output; >= 0
};

/// output = clamp(feed_forward + kp * error + integral).
///
/// At saturation the integrator stands still against errors that push further out, and gives back,
/// with the back-calculation's time constant, the part of the excess that is its own. It never
/// crosses zero by that: an excess owed to kp * error alone leaves it alone.
class PiController {
 public:
  static constexpr double kLongestStepS = 0.1;

  explicit PiController(const PiGains& gains) : gains_(gains) {}

  double update(const PiInput& input);
  /// The output so far turned out to be `excess` (asked minus applied) too large further down the
  /// line (acceleration limits, say): gives way as at its own saturation.
  void back_calculate(double excess, double dt_s);
  void reset() { integral_ = 0.0; }
  double integral() const { return integral_; }

 private:
  PiGains gains_;
  double integral_ = 0.0;
};

}  // namespace rovigo::control
