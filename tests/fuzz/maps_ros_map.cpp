// libFuzzer: ROS maps. The input is the YAML text, a zero byte, then the image.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "maps/error.h"
#include "maps/ros_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::size_t end = input.find('\0');
  const std::string yaml(input.substr(0, end));
  const std::string_view image = end == input.npos ? std::string_view{} : input.substr(end + 1);
  rovigo::maps::RosMapHeader header;
  header.resolution_m = 0.05;
  try {
    header = rovigo::maps::parse_ros_map_yaml(yaml, "fuzz.yaml");
  } catch (const rovigo::maps::InputError&) {
  }
  try {
    std::vector<std::string> warnings;
    const auto decoded = rovigo::maps::decode_gray_image(image, "fuzz.pgm");
    const auto grid = rovigo::maps::grid_from_ros_image(header, decoded, "fuzz", warnings);
    if (grid.cells.size() != grid.geometry.size()) __builtin_trap();
  } catch (const rovigo::maps::InputError&) {
  }
  return 0;
}
