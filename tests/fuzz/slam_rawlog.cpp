// Rawlogs, plain or gz: everything before the damage is handed out in time order, or one sentence
// says why nothing is.
#include <stdexcept>

#include "slam/recording/rawlog_objects.h"
#include "slam_fuzz_reader.h"

namespace rovigo::slam {
/// Stands in for the library's: what is left to MRPT crashes there, and is MRPT's to mend.
mrpt::serialization::CSerializable::Ptr read_with_mrpt(GzReadArchive&) {
  throw std::runtime_error("left to MRPT");
}
}  // namespace rovigo::slam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rovigo::slam::read_whatever_is_there(fuzz_file(".rawlog", data, size));
  return 0;
}
