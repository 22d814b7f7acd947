#pragma once
// Zeroes the command when what feeds it falls silent. Its time is an argument.

#include <optional>

namespace rovigo::control {

/// Expired from `timeout_s` after the last feed on, and before the first one. Times that run
/// backwards or are not finite count as expired: the safe side.
class Watchdog {
 public:
  explicit Watchdog(double timeout_s) : timeout_s_(timeout_s) {}

  void feed(double now_s) { fed_s_ = now_s; }
  void clear() { fed_s_.reset(); }
  bool expired(double now_s) const;
  /// Seconds since the last feed; infinite before the first.
  double silence_s(double now_s) const;

 private:
  double timeout_s_;
  std::optional<double> fed_s_;
};

}  // namespace rovigo::control
