// libFuzzer: MovingAI maps and scenario files.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "maps/error.h"
#include "maps/movingai.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const auto grid = rovigo::maps::parse_movingai_map(text, "fuzz.map");
    if (grid.cells.size() != grid.geometry.size()) __builtin_trap();
  } catch (const rovigo::maps::InputError&) {
  }
  try {
    rovigo::maps::parse_movingai_scenario(text, "fuzz.scen");
  } catch (const rovigo::maps::InputError&) {
  }
  return 0;
}
