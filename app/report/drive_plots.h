#pragma once
// The plots of a drive, as in mission R12: errors and both commands over time.

#include <string>
#include <vector>

#include "app/report/svg_plot.h"
#include "control/drive_log.h"

namespace rovigo::app {

struct NamedPlot {
  std::string file;  ///< without folder, "heading_error.svg"
  Plot plot;
};

/// Heading error, position error, speed, turn rate, and the estimate's error, with stretches of
/// doubtful and lost poses shaded. Errors are measured on the true poses.
std::vector<NamedPlot> drive_plots(const control::DriveLog& log,
                                   const planning::Trajectory& planned);

}  // namespace rovigo::app
