// Rawlogs, plain or gz: everything before the damage is handed out in time order, or one sentence
// says why nothing is.
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

#include "maps/error.h"
#include "slam/recording/images.h"
#include "slam/recording/rawlog_objects.h"
#include "slam/recording/recording.h"
#include "slam_fuzz_file.h"

namespace rovigo::slam {
/// Stands in for the library's: what is left to MRPT crashes there, and is MRPT's to mend.
mrpt::serialization::CSerializable::Ptr read_with_mrpt(GzReadArchive&) {
  throw std::runtime_error("left to MRPT");
}
}  // namespace rovigo::slam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rovigo::slam;
  const auto path = fuzz_file(".rawlog", data, size);
  try {
    const auto reader = open_recording(path);
    const Rig& rig = reader->info().rig;
    mrpt::Clock::time_point last{};
    while (const auto observation = reader->next()) {
      if (observation->timestamp < last) std::abort();
      last = observation->timestamp;
      const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(observation.get());
      if (scan == nullptr) continue;
      const cv::Size size_px(static_cast<int>(rig.camera.ncols),
                             static_cast<int>(rig.camera.nrows));
      if (color_view(*scan).size() != size_px || depth_view(*scan).size() != size_px) std::abort();
    }
  } catch (const rovigo::maps::InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) std::abort();
  }
  return 0;
}
