#include "app/report/track_page.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "app/report/number_text.h"
#include "app/report/page_parts.h"
#include "app/report/strip_plot.h"
#include "app/report/svg_plot.h"
#include "app/text.h"
#include "app/track/controller_comparison.h"

namespace rovigo::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kOurs = 0, kTheirs = 1, kPlan = 3;  // colours
constexpr double kMillimetres = 1000.0;
constexpr double kLostM = 0.5;  // farther off its path a drive is no longer drawn: it ran away
constexpr std::size_t kMostLines = 3;  // of one controller in a plot over time

/// A run's name taken apart, with its figures and what is drawn of it.
struct Entry {
  std::string group, trajectory, controller, speed;
  const Json* run = nullptr;
  const DriveSeries* series = nullptr;  ///< may be missing

  double figure(const char* key) const { return (*run)[key].get<double>(); }
  double rms_mm() const { return kMillimetres * figure("cross_track_rms_m"); }
  bool passed() const { return (*run)["passed"].get<bool>(); }
  std::uint64_t seed() const { return (*run)["seed"].get<std::uint64_t>(); }
  bool is_reference() const { return controller == "reference"; }
  int color() const { return is_reference() ? kTheirs : kOurs; }
};

Entry entry_of(const Json& run) {
  Entry e;
  auto parts = split(run["name"].get<std::string>(), '/');
  parts.resize(4);
  e.group = parts[0];
  e.trajectory = parts[1];
  e.controller = parts[2];
  e.speed = parts[3];
  e.run = &run;
  return e;
}

std::vector<Entry> entries_of(const TrackPageInput& in) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < in.result.runs.size(); ++i) {
    entries.push_back(entry_of(in.result.runs[i]));
    if (i < in.series.size()) entries.back().series = &in.series[i];
  }
  return entries;
}

template <class Key>
auto grouped(const std::vector<Entry>& entries, const Key& key) {
  std::map<std::string, std::vector<const Entry*>> out;
  for (const Entry& e : entries) out[key(e)].push_back(&e);
  return out;
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? 0.0 : (values[(n - 1) / 2] + values[n / 2]) / 2;
}

double largest(const std::vector<const Entry*>& entries, const char* key) {
  double most = 0.0;
  for (const Entry* e : entries) most = std::max(most, e->figure(key));
  return most;
}

std::string figures(const TrackPageInput& in, const std::vector<Entry>& entries) {
  double worst = 0.0, collisions = 0.0;
  for (const Entry& e : entries) {
    if (!e.is_reference()) worst = std::max(worst, e.figure("cross_track_rms_m"));
    collisions += e.figure("collisions");
  }
  const std::size_t failed = failed_runs(in.result);
  return "<div class=\"figures\">\n" + page_figure("runs", std::to_string(entries.size())) +
         page_figure("passed", std::to_string(entries.size() - failed)) +
         page_figure("failed", std::to_string(failed)) +
         page_figure("worst cross-track error of our controller, RMS", quantity(worst, "m")) +
         page_figure("collisions", fixed(collisions, 0)) + "</div>\n";
}

std::string failures_table(const std::vector<Entry>& entries) {
  std::string rows;
  for (const Entry& e : entries) {
    if (e.passed()) continue;
    std::vector<std::string> why;
    for (const Json& f : (*e.run)["failures"]) why.push_back(f.get<std::string>());
    rows += page_cells({(*e.run)["name"].get<std::string>() + ", seed " + std::to_string(e.seed()),
                        join(why, "; ")});
  }
  return rows.empty()
             ? rows
             : "<h2>Failed</h2>\n<table>" + page_heads({"Run", "Why"}) + rows + "</table>\n";
}

std::string disturbances_table(const std::vector<Entry>& entries) {
  std::string out = "<h2>By disturbance</h2>\n<table>" +
                    page_heads({"Group", "Controller", "Passed", "Median RMS", "Worst RMS",
                                "Largest error", "Worst at the goal", "Longest settling"});
  const auto key = [](const Entry& e) { return e.group + "/" + e.controller; };
  for (const auto& [name, runs] : grouped(entries, key)) {
    std::vector<double> rms;
    std::size_t passed = 0;
    for (const Entry* e : runs) {
      rms.push_back(e->figure("cross_track_rms_m"));
      passed += e->passed() ? 1 : 0;
    }
    out += page_cells({runs[0]->group, runs[0]->controller,
                       std::to_string(passed) + " of " + std::to_string(runs.size()),
                       quantity(median_of(rms), "m"),
                       quantity(largest(runs, "cross_track_rms_m"), "m"),
                       quantity(largest(runs, "cross_track_max_m"), "m"),
                       quantity(largest(runs, "final_position_error_m"), "m"),
                       quantity(largest(runs, "settling_s"), "s")});
  }
  return out + "</table>\n";
}

template <class Key>
std::string distribution(const std::string& title, const std::vector<Entry>& entries,
                         const Key& key) {
  std::vector<StripRow> rows;
  for (const auto& [name, runs] : grouped(entries, key)) {
    StripRow row{name, {}, runs[0]->color()};
    for (const Entry* e : runs) row.values.push_back(e->rms_mm());
    rows.push_back(std::move(row));
  }
  return "<div>" +
         strip_plot_svg(title, "cross-track error, RMS of each run (mm; bar: median)", rows) +
         "</div>\n";
}

std::string distributions(const std::vector<Entry>& entries) {
  return "<h2>Where the errors lie</h2>\n<div class=\"plots\">\n" +
         distribution("By disturbance and controller", entries,
                      [](const Entry& e) { return e.group + ", " + e.controller; }) +
         distribution("By trajectory and controller", entries,
                      [](const Entry& e) { return e.trajectory + ", " + e.controller; }) +
         "</div>\n";
}

/// Two results of what is else the same drive.
struct Pair {
  std::string what;
  Entry left, right;
};

std::string comparison(const std::string& title, const std::string& left, const std::string& right,
                       const std::vector<Pair>& pairs) {
  if (pairs.empty()) return {};
  std::string out =
      "<h2>" + escaped(title) + "</h2>\n<table>" +
      page_heads({"Drive", left + ": RMS", right + ": RMS", "Ratio", left + ": largest",
                  right + ": largest", left + ": how it ended", right + ": how it ended"});
  for (const Pair& p : pairs) {
    const double ours = p.left.rms_mm(), theirs = p.right.rms_mm();
    out += page_cells({p.what, quantity(p.left.figure("cross_track_rms_m"), "m"),
                       quantity(p.right.figure("cross_track_rms_m"), "m"),
                       ours > 0.0 ? fixed(theirs / ours, 1) : "-",
                       quantity(p.left.figure("cross_track_max_m"), "m"),
                       quantity(p.right.figure("cross_track_max_m"), "m"),
                       (*p.left.run)["status"].get<std::string>(),
                       (*p.right.run)["status"].get<std::string>()});
  }
  return out + "</table>\n";
}

std::string controllers_table(const TrackResult& result) {
  const auto comparisons = compare_controllers(result);
  if (comparisons.empty()) return {};
  std::string out = "<h2>Our controller against the thesis's law</h2>\n<table>" +
                    page_heads({"Drives", "ours: RMS", "the thesis's: RMS", "Ratio", "Median ratio",
                                "it arrived", "Ratio there", "Median there"});
  for (const ControllerComparison& c : comparisons) {
    const bool arrived = c.reference_arrived > 0;
    out += page_cells({c.what, quantity(c.rms_m, "m"), quantity(c.reference_rms_m, "m"),
                       fixed(c.ratio, 1), fixed(c.median_ratio, 1),
                       std::to_string(c.reference_arrived) + " of " + std::to_string(c.drives),
                       arrived ? fixed(c.arrived_ratio, 1) : "-",
                       arrived ? fixed(c.arrived_median_ratio, 1) : "-"});
  }
  return out + "</table>\n";
}

std::string controllers_compared(const std::vector<Entry>& entries) {
  const auto key = [](const Entry& e) {
    return e.group + "/" + e.trajectory + "/" + e.speed + " m/s, seed " + std::to_string(e.seed());
  };
  std::vector<Pair> pairs;
  for (const auto& [what, runs] : grouped(entries, key)) {
    if (runs.size() != 2) continue;
    const bool first_is_ours = !runs[0]->is_reference();
    pairs.push_back({what, *runs[first_is_ours ? 0 : 1], *runs[first_is_ours ? 1 : 0]});
  }
  return comparison("Two controllers side by side", "ours", "the thesis's", pairs);
}

std::string versions_compared(const TrackPageInput& in, const std::vector<Entry>& entries) {
  if (!in.against) return {};
  std::vector<Pair> pairs;
  for (const Json& run : in.against->runs) {
    for (const Entry& e : entries) {
      if ((*e.run)["name"] != run["name"] || (*e.run)["seed"] != run["seed"]) continue;
      pairs.push_back({run["name"].get<std::string>() + ", seed " + std::to_string(e.seed()), e,
                       entry_of(run)});
    }
  }
  return comparison("Two versions side by side", "this", in.against_name, pairs);
}

template <class Value>
std::string over_time(const std::string& title, const std::string& unit,
                      const std::vector<const Entry*>& shown, double least_span,
                      const Value& value) {
  Plot plot{.title = title, .x_label = "time (s)", .y_label = unit, .series = {}, .bands = {}};
  plot.least_y_span = least_span;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const DriveSeries& s = *shown[i]->series;
    PlotSeries line{shown[i]->group, s.time_s, value(s), static_cast<int>(i % 4), i >= 4};
    if (shown[i]->is_reference()) line.name += " (thesis)";
    plot.series.push_back(std::move(line));
  }
  return "<div>" + plot_svg(plot) + "</div>\n";
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& v : values) v *= factor;
  return values;
}

/// Samples until the drive runs away, if it does.
std::size_t samples_near_the_path(const DriveSeries& s) {
  std::size_t n = 0;
  while (n < s.cross_track_m.size() && std::abs(s.cross_track_m[n]) <= kLostM) ++n;
  return n;
}

/// The first run of each group, three of ours and one of the thesis's at most.
std::vector<const Entry*> shown_over_time(const std::vector<const Entry*>& runs) {
  std::vector<const Entry*> shown;
  std::map<bool, std::set<std::string>> groups;
  for (const Entry* e : runs) {
    auto& known = groups[e->is_reference()];
    if (known.size() >= (e->is_reference() ? 1 : kMostLines)) continue;
    if (known.insert(e->group).second) shown.push_back(e);
  }
  return shown;
}

std::string trajectory_section(const std::string& name, const std::vector<const Entry*>& runs) {
  std::vector<const Entry*> drawn;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(drawn),
               [](const Entry* e) { return e->series != nullptr; });
  if (drawn.empty()) return {};
  const auto line_of = [](const std::vector<double>& x, const std::vector<double>& y,
                          std::size_t count) {
    std::vector<TPoint2D> points;
    for (std::size_t i = 0; i < count; ++i) points.emplace_back(x[i], y[i]);
    return points;
  };
  std::vector<PathLine> lines;
  for (const Entry* e : drawn) {
    const DriveSeries& s = *e->series;
    lines.push_back({e->is_reference() ? "the thesis's" : "ours",
                     line_of(s.x_m, s.y_m, samples_near_the_path(s)), e->color(), false});
  }
  const DriveSeries& plan = *drawn[0]->series;
  lines.push_back({"planned", line_of(plan.planned_x_m, plan.planned_y_m, plan.planned_x_m.size()),
                   kPlan, true});
  const auto shown = shown_over_time(drawn);
  return "<h2>" + escaped(name) + "</h2>\n<div class=\"plots\">\n<div>" +
         path_plot_svg("All " + std::to_string(drawn.size()) + " drives (until 0.5 m off)", lines) +
         "</div>\n" +
         over_time("Cross-track error", "mm", shown, 10.0,
                   [](const DriveSeries& s) {
                     auto errors = scaled(s.cross_track_m, kMillimetres);
                     errors.resize(samples_near_the_path(s));
                     return errors;
                   }) +
         over_time("Commanded speed", "m/s", shown, 0.1,
                   [](const DriveSeries& s) { return s.speed_m_s; }) +
         over_time("Commanded turn rate", "rad/s", shown, 0.2,
                   [](const DriveSeries& s) { return s.turn_rate_rad_s; }) +
         "</div>\n";
}

}  // namespace

std::string track_page(const TrackPageInput& in) {
  const std::vector<Entry> entries = entries_of(in);
  const Json object = result_json(in.result);
  const std::string title = "Tracking tests: " + in.result.suite;
  const bool good = failed_runs(in.result) == 0;
  std::string out = page_begin(title);
  out += page_title(title, good, good ? "passed" : "failed");
  out += "<p class=\"summary\">" + escaped(result_message(in.result)) + "</p>\n";
  out += figures(in, entries) + failures_table(entries) + disturbances_table(entries) +
         distributions(entries) + controllers_table(in.result) + controllers_compared(entries) +
         versions_compared(in, entries);
  const auto by_trajectory =
      grouped(entries, [](const Entry& e) -> std::string { return e.trajectory; });
  for (const auto& [name, runs] : by_trajectory) out += trajectory_section(name, runs);
  out +=
      "<h2>Files beside this page</h2>\n<ul><li>track.json, runs.csv: the figures</li>"
      "<li>drives.json: what is drawn here</li><li>trajectories/: true and estimated poses of "
      "every run, TUM format</li></ul>\n<h2>Log hash</h2>\n<code>" +
      object["log_hash"].get<std::string>() + "</code>\n";
  return out + "</main></body>\n</html>\n";
}

}  // namespace rovigo::app
