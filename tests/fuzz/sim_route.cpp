// Any bytes as a route file: a route of finite waypoints, or one clear refusal.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "maps/error.h"
#include "sim/route.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const auto route = rovigo::sim::parse_route(text, "fuzz.yaml");
    if (route.waypoints.size() < 2 || !(route.speed_m_s > 0.0)) std::abort();
    for (const auto& p : route.waypoints) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) std::abort();
    }
  } catch (const rovigo::maps::InputError& e) {
    if (std::string(e.what()).rfind("fuzz.yaml", 0) != 0) std::abort();
  }
  return 0;
}
