#include "sim/command_link.h"

#include <algorithm>
#include <cmath>

namespace rovigo::sim {

namespace {
constexpr double kRoundingS = 1e-9;
}

TTwist2D CommandLink::pass(double time_s, const TTwist2D& command) {
  if (time_s + kRoundingS >= next_send_s_) {
    next_send_s_ += 1.0 / model_.rate_hz;
    send(time_s, command);
  }
  while (!under_way_.empty() && under_way_.front().arrives_s <= time_s + kRoundingS) {
    newest_ = under_way_.front().command;
    under_way_.pop_front();
  }
  return newest_;
}

void CommandLink::send(double time_s, const TTwist2D& command) {
  // Both numbers are drawn for every packet, so that one setting does not shift the other's draws.
  const bool is_lost = random_.uniform(0.0, 1.0) < model_.drop_share;
  const double age = model_.latency_s + model_.jitter_s * random_.uniform(-1.0, 1.0);
  if (is_lost) return;
  last_arrival_s_ = std::max(last_arrival_s_, time_s + std::max(age, 0.0));
  const bool usable = std::isfinite(command.vx) && std::isfinite(command.omega);
  under_way_.push_back({last_arrival_s_, usable ? command : TTwist2D()});
}

}  // namespace rovigo::sim
