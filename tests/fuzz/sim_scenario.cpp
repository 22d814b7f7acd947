// Any bytes as a scenario file: a scenario within its own ranges, or one clear refusal.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "maps/error.h"
#include "sim/fault_script.h"
#include "sim/scenario.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const auto scenario = rovigo::sim::parse_scenario(text, "fuzz.yaml");
    rovigo::maps::validate(scenario.camera);
    rovigo::maps::validate(scenario.imu);
    rovigo::maps::validate(scenario.wheels);
    rovigo::maps::validate(scenario.motor);
    rovigo::maps::validate(scenario.commands);
    rovigo::maps::validate(scenario.payload);
    rovigo::maps::validate(scenario.slope);
    rovigo::maps::validate(scenario.grip);
    for (const auto& fault : scenario.faults) rovigo::maps::validate(fault);
    const rovigo::sim::FaultScript script(scenario.faults, 1);
    script.active(rovigo::sim::FaultKind::kPosesLate, 1.0);
    rovigo::maps::validate(scenario.pose);
  } catch (const rovigo::maps::InputError& e) {
    if (std::string(e.what()).rfind("fuzz.yaml", 0) != 0) std::abort();  // names the file
  }
  return 0;
}
