#pragma once
// index.html of a drive report: one page that needs nothing but a browser.

#include <string>
#include <vector>

#include "app/report/drive_plots.h"
#include "app/report/drive_report.h"

namespace rovigo::app {

/// `map_png`: the picture's bytes, embedded in the page.
std::string drive_page(const DriveReportInput& input, const std::vector<NamedPlot>& plots,
                       const std::string& map_png);

/// RFC 4648, with padding.
std::string base64(const std::string& bytes);

}  // namespace rovigo::app
