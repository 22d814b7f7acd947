#include "app/report/drive_page.h"

#include "app/report/number_text.h"
#include "app/report/page_parts.h"

namespace rovigo::app {
namespace {

std::string figures(const DriveReportInput& in) {
  const control::DriveMetrics& m = in.metrics;
  return "<div class=\"figures\">\n" + page_figure("driven", quantity(m.driven_length_m, "m")) +
         page_figure("time", quantity(m.duration_s, "s")) +
         page_figure("cross-track error, RMS", quantity(m.cross_track_rms_m, "m")) +
         page_figure("cross-track error, largest", quantity(m.cross_track_max_m, "m")) +
         page_figure("distance from the goal", quantity(m.final_position_error_m, "m")) +
         page_figure("collisions", std::to_string(in.log.contact_events)) + "</div>\n";
}

std::string checks_table(const std::vector<ReportCheck>& checks) {
  if (checks.empty()) return {};
  std::string out =
      "<h2>Passed or not</h2>\n<table><tr><th>Figure</th><th class=\"n\">Measured</th>"
      "<th class=\"n\">At most</th><th></th></tr>\n";
  for (const ReportCheck& c : checks) {
    const bool pass = c.value <= c.limit;  // NaN fails
    out += "<tr><td>" + escaped(c.name) + "</td><td class=\"n\">" +
           escaped(quantity(c.value, c.unit)) + "</td><td class=\"n\">" +
           escaped(quantity(c.limit, c.unit)) + "</td><td class=\"" +
           (pass ? "pass\">✓ pass" : "fail\">✗ fail") + "</td></tr>\n";
  }
  return out + "</table>\n";
}

std::string row(const std::string& name, const std::string& value) {
  return "<tr><td>" + escaped(name) + "</td><td class=\"n\">" + escaped(value) + "</td></tr>\n";
}

std::string metrics_table(const DriveReportInput& in) {
  const control::DriveMetrics& m = in.metrics;
  std::string out = "<h2>All figures</h2>\n<table>\n";
  out += row("Planned length", quantity(m.path_length_m, "m"));
  out += row("Driven length", quantity(m.driven_length_m, "m"));
  out += row("Planned time", quantity(m.planned_duration_s, "s"));
  out += row("Time taken", quantity(m.duration_s, "s"));
  out += row("Cross-track error, RMS", quantity(m.cross_track_rms_m, "m"));
  out += row("Cross-track error, largest", quantity(m.cross_track_max_m, "m"));
  out += row("Along-track error, RMS", quantity(m.along_track_rms_m, "m"));
  out += row("Heading error, RMS", quantity(m.heading_rms_rad, "rad"));
  out += row("Distance from the goal at the end", quantity(m.final_position_error_m, "m"));
  if (m.goal_heading_given) {
    out += row("Heading error at the end", quantity(m.final_heading_error_rad, "rad"));
  }
  out += row("Error of the estimated position, RMS", quantity(m.estimate_rms_m, "m"));
  out += row("Highest commanded speed", quantity(m.max_speed_m_s, "m/s"));
  out += row("Highest commanded turn rate", quantity(m.max_yaw_rate_rad_s, "rad/s"));
  out += row("Time at a speed or turn limit", quantity(m.saturation_share, "%"));
  out += row("Collisions", std::to_string(in.log.contact_events));
  out += row("How it ended", control::to_string(in.log.status));
  return out + "</table>\n";
}

std::string facts_table(const DriveReportInput& in) {
  if (in.facts.empty()) return {};
  std::string out = "<h2>What was driven</h2>\n<table>\n";
  for (const auto& [name, value] : in.facts) out += row(name, value);
  return out + "</table>\n";
}

std::string files_list(const std::vector<NamedPlot>& plots) {
  struct Entry {
    const char* file;
    const char* what;
  };
  constexpr Entry kFiles[] = {
      {"map.png", "the picture above"},
      {"drive.json", "the figures, for programs"},
      {"trajectory.csv", "the plan: time, pose, speed, turn rate, curvature"},
      {"drive.csv", "every control step"},
      {"trajectory_true.txt", "the true poses, TUM format"},
      {"trajectory_estimated.txt", "the poses the controller was given, TUM format"},
  };
  std::string out = "<h2>Files beside this page</h2>\n<ul>\n";
  for (const Entry& e : kFiles) {
    out += std::string("<li><a href=\"") + e.file + "\">" + e.file + "</a>: " + e.what + "</li>\n";
  }
  out += "<li>";
  for (std::size_t i = 0; i < plots.size(); ++i) {
    out += (i > 0 ? ", " : "") + ("<a href=\"" + plots[i].file + "\">") + plots[i].file + "</a>";
  }
  return out + ": the plots</li>\n</ul>\n";
}

}  // namespace

std::string base64(const std::string& bytes) {
  constexpr char kAlphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < have ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= have ? kAlphabet[group >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return out;
}

std::string drive_page(const DriveReportInput& in, const std::vector<NamedPlot>& plots,
                       const std::string& map_png) {
  std::string out = page_begin(in.title);
  out += page_title(in.title, in.succeeded, in.succeeded ? "succeeded" : "failed");
  out += "<p class=\"summary\">" + escaped(in.summary) + "</p>\n";
  out += figures(in);
  out +=
      "<img class=\"map\" alt=\"Map with the planned and the driven path\" "
      "src=\"data:image/png;base64," +
      base64(map_png) + "\">\n";
  out += "<h2>Over time</h2>\n<div class=\"plots\">\n";
  for (const NamedPlot& p : plots) out += "<div>" + plot_svg(p.plot) + "</div>\n";
  out += "</div>\n<div class=\"columns\">\n";
  out += "<div>" + checks_table(in.checks) + facts_table(in) + files_list(plots) + "</div>\n";
  out += "<div>" + metrics_table(in) + "</div>\n</div>\n";
  if (!in.command.empty()) {
    out += "<h2>To repeat it</h2>\n<code>" + escaped(in.command) + "</code>\n";
  }
  return out + "</main></body>\n</html>\n";
}

}  // namespace rovigo::app
