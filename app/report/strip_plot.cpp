#include "app/report/strip_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "app/report/number_text.h"
#include "app/report/svg_plot.h"

namespace rovigo::app {
namespace {

constexpr double kWidth = 640, kRight = 18;

std::string number(double v) { return fixed(v, 1); }

std::string text(double x, double y, const char* css, const std::string& content,
                 const char* anchor = "start") {
  return std::string("<text class=\"") + css + "\" text-anchor=\"" + anchor + "\" x=\"" +
         number(x) + "\" y=\"" + number(y) + "\">" + escaped(content) + "</text>\n";
}

std::string line(const std::string& css, double x1, double y1, double x2, double y2) {
  return "<line class=\"" + css + "\" x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" +
         number(x2) + "\" y2=\"" + number(y2) + "\"/>\n";
}

std::string svg(const std::string& title, double height, const std::string& inside) {
  return "<svg class=\"plot\" viewBox=\"0 0 " + number(kWidth) + " " + number(height) +
         "\" role=\"img\" aria-label=\"" + escaped(title) + "\">\n" + text(14, 22, "title", title) +
         inside + "</svg>\n";
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

/// Whole powers of ten around the values.
struct LogAxis {
  double low = 0.0, high = 1.0;  ///< exponents
  double left = 0.0, right = kWidth - kRight;
  double px(double value) const {
    const double exponent = value > 0.0 ? std::log10(value) : low;
    return left + (std::clamp(exponent, low, high) - low) / (high - low) * (right - left);
  }
};

LogAxis axis_of(const std::vector<StripRow>& rows) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  std::size_t longest = 0;
  for (const StripRow& row : rows) {
    longest = std::max(longest, row.name.size());
    for (const double v : row.values) {
      if (!std::isfinite(v) || v <= 0.0) continue;
      least = std::min(least, v);
      most = std::max(most, v);
    }
  }
  LogAxis axis;
  if (most > 0.0) axis = {std::floor(std::log10(least)), std::ceil(std::log10(most))};
  if (axis.high <= axis.low) axis.high = axis.low + 1.0;
  axis.left = 30.0 + 6.6 * static_cast<double>(longest);
  return axis;
}

std::string power_of_ten(double exponent) {
  return fixed(std::pow(10.0, exponent), std::max(0, static_cast<int>(-exponent)));
}

std::string strip(const StripRow& row, const LogAxis& axis, double y) {
  const std::string color = " c" + std::to_string(row.color);
  std::string out = text(axis.left - 10, y + 4, "tick", row.name, "end");
  out += line("grid", axis.left, y, axis.right, y);
  std::vector<double> known;
  for (const double v : row.values) {
    if (!std::isfinite(v)) continue;
    known.push_back(v);
    out += "<circle class=\"line" + color + "\" cx=\"" + number(axis.px(v)) + "\" cy=\"" +
           number(y) + "\" r=\"3.5\"/>\n";
  }
  if (known.empty()) return out;
  const double middle = axis.px(median(known));
  return out + line("line" + color, middle, y - 9, middle, y + 9);
}

}  // namespace

std::string strip_plot_svg(const std::string& title, const std::string& label,
                           const std::vector<StripRow>& rows) {
  constexpr double kTop = 40, kRowPx = 24;
  const LogAxis axis = axis_of(rows);
  const double bottom = kTop + kRowPx * static_cast<double>(rows.size());
  std::string out;
  for (double e = axis.low; e <= axis.high; e += 1.0) {
    const double x = axis.px(std::pow(10.0, e));
    out +=
        line("grid", x, kTop, x, bottom) + text(x, bottom + 16, "tick", power_of_ten(e), "middle");
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out += strip(rows[i], axis, kTop + kRowPx * (static_cast<double>(i) + 0.5));
  }
  out += text((axis.left + axis.right) / 2, bottom + 36, "label", label, "middle");
  return svg(title, bottom + 46, out);
}

std::string path_plot_svg(const std::string& title, const std::vector<PathLine>& lines) {
  constexpr double kLeft = 20, kTop = 58, kLeastM = 0.5, kMostPx = 420;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  TPoint2D low(kInfinity, kInfinity), high(-kInfinity, -kInfinity);
  for (const PathLine& l : lines) {
    for (const TPoint2D& p : l.points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  }
  if (!(low.x <= high.x)) low = high = {};
  const double wide = std::max(high.x - low.x, kLeastM), tall = std::max(high.y - low.y, 0.1);
  const double scale = std::min((kWidth - kLeft - kRight) / wide, kMostPx / tall);
  const double bottom = kTop + scale * tall;

  std::string out;
  std::set<std::string> named;
  double legend_x = kLeft;
  for (const PathLine& l : lines) {
    const std::string css = "line c" + std::to_string(l.color) + (l.dashed ? " dashed" : "");
    out += "<polyline class=\"" + css + "\" points=\"";
    for (const TPoint2D& p : l.points) {
      out += number(kLeft + scale * (p.x - low.x)) + "," + number(bottom - scale * (p.y - low.y)) +
             " ";
    }
    out += "\"/>\n";
    if (!named.insert(l.name).second) continue;
    out += line(css, legend_x, 44, legend_x + 20, 44) + text(legend_x + 26, 48, "legend", l.name);
    legend_x += 46 + 7.1 * static_cast<double>(l.name.size());
  }
  const auto ticks = round_ticks(0.0, wide, 6);
  const double metre = ticks.size() > 1 ? ticks[1] - ticks[0] : wide;
  out += line("zero", kLeft, bottom + 16, kLeft + scale * metre, bottom + 16);
  out += text(kLeft + scale * metre + 8, bottom + 20, "tick",
              fixed(metre, tick_decimals(ticks)) + " m");
  return svg(title, bottom + 30, out);
}

}  // namespace rovigo::app
