#pragma once
// The way of commands to the motors: packets that come late, unevenly, or never.

#include <deque>

#include "maps/geometry.h"
#include "sim/random.h"
#include "sim/scenario.h"

namespace rovigo::sim {

/// Packets arrive in the order they were sent; between two, the motors hold the last one.
class CommandLink {
 public:
  CommandLink(const CommandLinkModel& model, std::uint64_t seed) : model_(model), random_(seed) {}

  /// What the motors follow at `time_s`, when `command` is what the sender wants now. A command
  /// that is not finite counts as standstill.
  TTwist2D pass(double time_s, const TTwist2D& command);

 private:
  struct Packet {
    double arrives_s;
    TTwist2D command;
  };
  void send(double time_s, const TTwist2D& command);

  CommandLinkModel model_;
  RandomStream random_;
  double next_send_s_ = 0.0;
  double last_arrival_s_ = 0.0;
  std::deque<Packet> under_way_;
  TTwist2D newest_;
};

}  // namespace rovigo::sim
