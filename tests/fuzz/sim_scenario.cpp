// Any bytes as a scenario file: a scenario within its own ranges, or one clear refusal.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "maps/error.h"
#include "sim/scenario.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const auto scenario = rovigo::sim::parse_scenario(text, "fuzz.yaml");
    rovigo::maps::validate(scenario.camera);
    rovigo::maps::validate(scenario.imu);
    rovigo::maps::validate(scenario.wheels);
    rovigo::maps::validate(scenario.motor);
    rovigo::maps::validate(scenario.pose);
  } catch (const rovigo::maps::InputError& e) {
    if (std::string(e.what()).rfind("fuzz.yaml", 0) != 0) std::abort();  // names the file
  }
  return 0;
}
