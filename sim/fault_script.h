#pragma once
// Which of a scenario's faults rule when.

#include <cstdint>
#include <vector>

#include "sim/scenario.h"

namespace rovigo::sim {

/// As Fault::kind names them.
enum class FaultKind {
  kPosesStall,
  kPosesLate,
  kPosesNotFinite,
  kSensorsStall,
  kSensorsLate,
  kCameraLate,
  kSetPointsStop,
  kBatteryLow,
  kManualTakeover
};

class FaultScript {
 public:
  /// Draws by `seed` when each fault begins. Precondition: every kind is a known one.
  FaultScript(const std::vector<Fault>& faults, std::uint64_t seed);

  /// The first fault of this kind that rules at `time_s`, since the recording's first moment.
  const Fault* active(FaultKind kind, double time_s) const;

 private:
  struct Entry {
    FaultKind kind;
    double begin_s;
    double end_s;
    Fault fault;
  };
  std::vector<Entry> entries_;
};

}  // namespace rovigo::sim
