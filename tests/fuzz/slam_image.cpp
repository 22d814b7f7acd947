// Encoded images of a recording: any bytes decode or are refused with a reason, never a crash.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "slam/recording/images.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  std::string problem;
  const cv::Mat color = rovigo::slam::decode_color(bytes, problem);
  if (color.empty() == problem.empty()) std::abort();  // an image or a reason, not both or neither
  mrpt::math::CMatrix_u16 depth;
  if (rovigo::slam::decode_depth(bytes, depth, problem) != problem.empty()) std::abort();
  return 0;
}
