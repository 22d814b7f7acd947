#pragma once
// The print of an ArUco marker. The one place in sim that knows OpenCV's aruco.

#include <array>
#include <cstdint>

namespace rovigo::sim {

/// Of the dictionary 4x4_50: ids 0 .. 49.
inline constexpr std::uint32_t kMarkerIds = 50;
/// Cells along the side of the whole print: the marker's own 6 and a white one on either side.
inline constexpr int kMarkerPrintCells = 8;
/// Side of the marker (its black square) by side of the print.
inline constexpr double kMarkerShare = 6.0 / kMarkerPrintCells;

/// True where the print is black; row 0 is the top. Precondition: id < kMarkerIds.
using MarkerPrint = std::array<std::array<bool, kMarkerPrintCells>, kMarkerPrintCells>;
MarkerPrint marker_print(std::uint32_t id);

}  // namespace rovigo::sim
