// Any bytes as a suite of tracking tests: its runs, sorted and no two alike, or one clear refusal.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "app/track/suite.h"
#include "maps/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rovigo;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    app::TrackSuite suite = app::parse_suite(text, "fuzz.yaml");
    for (const auto& [name, shape] : suite.trajectories) maps::validate(shape);
    const auto cases = app::cases_of(suite);
    for (std::size_t i = 1; i < cases.size(); ++i) {
      const auto key = [&](std::size_t k) { return std::pair(cases[k].name, cases[k].seed); };
      if (!(key(i - 1) < key(i))) std::abort();
    }
  } catch (const maps::InputError& e) {
    if (std::string(e.what()).rfind("fuzz.yaml", 0) != 0) std::abort();  // names the file
  }
  return 0;
}
