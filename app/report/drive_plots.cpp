#include "app/report/drive_plots.h"

#include <cmath>
#include <limits>

#include "control/tracking_metrics.h"

namespace rovigo::app {
namespace {

using control::DriveLog;
using control::DriveStep;
using control::PoseQuality;

constexpr double kDegrees = 180.0 / maps::kPi;
constexpr double kMillimetres = 1000.0;

template <class Value>
PlotSeries over_time(const DriveLog& log, std::string name, int color, const Value& value) {
  PlotSeries s;
  s.name = std::move(name);
  s.color = color;
  s.x.reserve(log.steps.size());
  s.y.reserve(log.steps.size());
  for (const DriveStep& step : log.steps) {
    s.x.push_back(step.time_s);
    s.y.push_back(value(step));
  }
  return s;
}

std::vector<PlotBand> quality_bands(const DriveLog& log) {
  std::vector<PlotBand> bands;
  PoseQuality last = PoseQuality::kGood;
  for (const DriveStep& step : log.steps) {
    if (step.quality != PoseQuality::kGood) {
      const bool lost = step.quality == PoseQuality::kLost;
      if (step.quality != last) {
        bands.push_back(
            {step.time_s, step.time_s, lost ? 1 : 0, lost ? "pose lost" : "pose doubtful"});
      }
      bands.back().to = step.time_s;
    }
    last = step.quality;
  }
  return bands;
}

Plot plot_of(const DriveLog& log, std::string title, std::string y_label, double least_y_span,
             std::vector<PlotSeries> series) {
  Plot plot;
  plot.title = std::move(title);
  plot.x_label = "time (s)";
  plot.y_label = std::move(y_label);
  plot.series = std::move(series);
  plot.least_y_span = least_y_span;
  plot.bands = quality_bands(log);
  return plot;
}

/// 1, or not a number where there is no estimate: the line gets a gap.
double known(const DriveStep& s) {
  return s.quality == PoseQuality::kLost ? std::numeric_limits<double>::quiet_NaN() : 1.0;
}

PlotSeries dashed(PlotSeries s) {
  s.dashed = true;
  return s;
}

}  // namespace

std::vector<NamedPlot> drive_plots(const DriveLog& log, const planning::Trajectory& planned) {
  const auto heading = [](const DriveStep& s) {
    return kDegrees * maps::wrap_angle(s.true_pose.phi - s.reference.pose.phi);
  };
  const auto seen_heading = [](const DriveStep& s) {
    return known(s) * kDegrees * maps::wrap_angle(s.estimated_pose.phi - s.reference.pose.phi);
  };
  const auto across = [&planned](const DriveStep& s) {
    return planned.points.empty() ? 0.0
                                  : kMillimetres * control::cross_track_error_m(
                                                       planned, maps::position_of(s.true_pose));
  };
  const auto along = [](const DriveStep& s) {
    const TPose2D& r = s.reference.pose;
    return kMillimetres *
           ((s.true_pose.x - r.x) * std::cos(r.phi) + (s.true_pose.y - r.y) * std::sin(r.phi));
  };
  const auto estimate = [](const DriveStep& s) {
    return known(s) * kMillimetres *
           maps::distance(maps::position_of(s.true_pose), maps::position_of(s.estimated_pose));
  };
  const auto sigma = [](const DriveStep& s) {
    return known(s) * kMillimetres * s.sigma_position_m;
  };

  return {
      {"heading_error.svg", plot_of(log, "Heading error", "degrees", 4.0,
                                    {over_time(log, "true", 1, heading),
                                     dashed(over_time(log, "as estimated", 2, seen_heading))})},
      {"position_error.svg", plot_of(log, "Position error against the plan", "mm", 20.0,
                                     {over_time(log, "across (left +)", 1, across),
                                      dashed(over_time(log, "along (ahead +)", 0, along))})},
      {"speed.svg",
       plot_of(log, "Speed", "m/s", 0.0,
               {over_time(log, "driven", 1, [](const DriveStep& s) { return s.true_twist.vx; }),
                dashed(over_time(log, "command", 0,
                                 [](const DriveStep& s) { return s.command.vx; }))})},
      {"turn_rate.svg",
       plot_of(log, "Turn rate", "rad/s", 0.2,
               {over_time(log, "driven", 1, [](const DriveStep& s) { return s.true_twist.omega; }),
                dashed(over_time(log, "command", 0,
                                 [](const DriveStep& s) { return s.command.omega; }))})},
      {"estimate_error.svg", plot_of(log, "Error of the estimated position", "mm", 20.0,
                                     {over_time(log, "distance to the truth", 1, estimate),
                                      dashed(over_time(log, "1 sigma, as stated", 0, sigma))})},
  };
}

}  // namespace rovigo::app
