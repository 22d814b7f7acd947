#include "sim/marker_texture.h"

#include <opencv2/aruco.hpp>

namespace rovigo::sim {

MarkerPrint marker_print(std::uint32_t id) {
  constexpr int kMarkerCells = kMarkerPrintCells - 2;
  cv::Mat cells;
  cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50)
      ->drawMarker(static_cast<int>(id), kMarkerCells, cells, 1);
  MarkerPrint print{};
  for (int y = 0; y < kMarkerCells; ++y) {
    for (int x = 0; x < kMarkerCells; ++x) {
      print[static_cast<std::size_t>(y + 1)][static_cast<std::size_t>(x + 1)] =
          cells.at<std::uint8_t>(y, x) == 0;
    }
  }
  return print;
}

}  // namespace rovigo::sim
