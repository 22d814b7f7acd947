// Any bytes as the result of a share of a suite, for --merge and --against: what is read can be
// merged and printed in every form, or one clear refusal.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "app/track/drive_series.h"
#include "app/track/track_result.h"
#include "maps/error.h"
#include "slam_fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rovigo;
  const auto file = fuzz_file(".json", data, size);
  const auto try_out = [&](const auto& work) {
    try {
      work();
    } catch (const maps::InputError& e) {
      if (std::string(e.what()).empty()) std::abort();
    }
  };
  try_out([&] {
    const app::TrackResult result = app::read_result(file);
    app::result_json(result).dump();
    app::result_rows(result);
    app::result_csv(result);
  });
  try_out([&] { app::merge_results({file}); });
  try_out([&] { app::series_json(app::read_series(file)).dump(); });
  return 0;
}
