#pragma once
// Pictures of many runs at once, as SVG for pages that include plot_style(): where values lie, row
// by row, and paths in the plane.

#include <string>
#include <vector>

#include "maps/geometry.h"

namespace rovigo::app {

struct StripRow {
  std::string name;
  std::vector<double> values;
  int color = 0;  ///< as PlotSeries::color
};

/// A dot for each value of each row on one logarithmic axis, and a bar at its median. Values that
/// are not above zero stand at the left end, what is not finite is left out.
std::string strip_plot_svg(const std::string& title, const std::string& label,
                           const std::vector<StripRow>& rows);

struct PathLine {
  std::string name;  ///< for the legend, where lines of the same name share an entry
  std::vector<TPoint2D> points;
  int color = 0;
  bool dashed = false;
};

/// Lines in the plane, x to the right, y up, both in metres at the same scale.
std::string path_plot_svg(const std::string& title, const std::vector<PathLine>& lines);

}  // namespace rovigo::app
