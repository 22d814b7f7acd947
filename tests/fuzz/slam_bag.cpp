// ROS 1 bags: everything that is whole is handed out in time order, or one sentence says why not.
// Start from the bags that the unit tests write; the fuzzer finds the compressed chunks by itself.
#include "slam_fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rovigo::slam::read_whatever_is_there(fuzz_file(".bag", data, size));
  return 0;
}
