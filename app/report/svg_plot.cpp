#include "app/report/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/report/number_text.h"

namespace rovigo::app {
namespace {

constexpr double kLeft = 62, kRight = 14, kTop = 58, kBottom = 44;  // margins, px
constexpr double kLegendGap = 14, kCharacterPx = 7.1;

struct Range {
  double low = 0.0;
  double high = 1.0;
};

/// From data to pixels.
struct Frame {
  Range x, y;
  double left, right, top, bottom;
  double px(double v) const { return left + (v - x.low) / (x.high - x.low) * (right - left); }
  double py(double v) const { return bottom - (v - y.low) / (y.high - y.low) * (bottom - top); }
};

void widen(Range& range, const std::vector<double>& values) {
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    range.low = std::min(range.low, v);
    range.high = std::max(range.high, v);
  }
}

Range empty_range() {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  return {kInf, -kInf};
}

Range x_range(const Plot& plot) {
  Range r = empty_range();
  for (const auto& s : plot.series) widen(r, s.x);
  if (!(r.low <= r.high)) r = {0.0, 1.0};
  if (r.high - r.low < 1e-9) r.high = r.low + 1.0;
  return r;
}

Range y_range(const Plot& plot) {
  Range r = empty_range();
  for (const auto& s : plot.series) widen(r, s.y);
  if (!(r.low <= r.high)) r = {0.0, 0.0};
  r.low = std::min(r.low, 0.0);  // errors and speeds are read against zero
  r.high = std::max(r.high, 0.0);
  const double missing = plot.least_y_span - (r.high - r.low);
  if (missing > 0.0) {
    r.low -= r.low < 0.0 || r.high <= 0.0 ? missing / 2 : 0.0;
    r.high = r.low + plot.least_y_span;
  }
  if (r.high - r.low < 1e-12) r.high = r.low + 1.0;
  const double room = 0.06 * (r.high - r.low);
  return {r.low < 0.0 ? r.low - room : r.low, r.high + room};
}

std::string number(double v) { return fixed(v, 1); }

std::string text(double x, double y, const char* css, const std::string& content,
                 const std::string& more = "") {
  return "<text class=\"" + std::string(css) + "\" x=\"" + number(x) + "\" y=\"" + number(y) +
         "\"" + more + ">" + escaped(content) + "</text>\n";
}

std::string line(const char* css, double x1, double y1, double x2, double y2) {
  return "<line class=\"" + std::string(css) + "\" x1=\"" + number(x1) + "\" y1=\"" + number(y1) +
         "\" x2=\"" + number(x2) + "\" y2=\"" + number(y2) + "\"/>\n";
}

std::string rectangle(const std::string& css, double x, double y, double w, double h) {
  return "<rect class=\"" + css + "\" x=\"" + number(x) + "\" y=\"" + number(y) + "\" width=\"" +
         number(w) + "\" height=\"" + number(h) + "\"/>\n";
}

std::string axes(const Plot& plot, const Frame& f) {
  std::string out;
  const auto y_ticks = round_ticks(f.y.low, f.y.high, 7);
  const int y_decimals = tick_decimals(y_ticks);
  for (const double v : y_ticks) {
    out += line(v == 0.0 ? "zero" : "grid", f.left, f.py(v), f.right, f.py(v));
    out += text(f.left - 7, f.py(v) + 4, "tick", fixed(v, y_decimals), " text-anchor=\"end\"");
  }
  const auto x_ticks = round_ticks(f.x.low, f.x.high, 10);
  const int x_decimals = tick_decimals(x_ticks);
  for (const double v : x_ticks) {
    out += line("grid", f.px(v), f.top, f.px(v), f.bottom);
    out += text(f.px(v), f.bottom + 16, "tick", fixed(v, x_decimals), " text-anchor=\"middle\"");
  }
  out +=
      text((f.left + f.right) / 2, f.bottom + 35, "label", plot.x_label, " text-anchor=\"middle\"");
  const double middle = (f.top + f.bottom) / 2;
  out += text(16, middle, "label", plot.y_label,
              " text-anchor=\"middle\" transform=\"rotate(-90 16 " + number(middle) + ")\"");
  return out;
}

/// At most two points a pixel column (its lowest and highest value, in order of appearance), so
/// that long drives keep their peaks and pages stay small.
std::string polyline(const PlotSeries& s, const Frame& f) {
  const std::string css = "line c" + std::to_string(s.color) + (s.dashed ? " dashed" : "");
  std::string out, points;
  const auto flush = [&] {
    if (!points.empty()) out += "<polyline class=\"" + css + "\" points=\"" + points + "\"/>\n";
    points.clear();
  };
  const auto add = [&](std::size_t i) {
    if (!points.empty()) points += ' ';
    points += number(f.px(s.x[i])) + "," + number(f.py(s.y[i]));
  };
  const std::size_t n = std::min(s.x.size(), s.y.size());
  std::size_t i = 0;
  while (i < n) {
    if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) {
      flush();
      ++i;
      continue;
    }
    const double column = std::floor(f.px(s.x[i]));
    std::size_t low = i, high = i;
    for (; i < n && std::isfinite(s.y[i]) && std::floor(f.px(s.x[i])) == column; ++i) {
      if (s.y[i] < s.y[low]) low = i;
      if (s.y[i] > s.y[high]) high = i;
    }
    add(std::min(low, high));
    if (low != high) add(std::max(low, high));
  }
  flush();
  return out;
}

std::string legend(const Plot& plot, const Frame& f) {
  std::string out;
  double x = f.left;
  const double y = kTop - 14;
  const auto label = [&](const std::string& name) {
    out += text(x + 26, y + 4, "legend", name);
    x += 26 + kCharacterPx * static_cast<double>(name.size()) + kLegendGap;
  };
  for (const auto& s : plot.series) {
    const std::string css = "line c" + std::to_string(s.color) + (s.dashed ? " dashed" : "");
    out += line(css.c_str(), x, y, x + 20, y);
    label(s.name);
  }
  std::vector<std::string> seen;
  for (const auto& band : plot.bands) {
    if (std::find(seen.begin(), seen.end(), band.name) != seen.end()) continue;
    seen.push_back(band.name);
    out += rectangle("band b" + std::to_string(band.kind), x, y - 6, 20, 12);
    label(band.name);
  }
  return out;
}

std::string body(const Plot& plot) {
  const Frame f{x_range(plot),          y_range(plot), kLeft,
                plot.width_px - kRight, kTop,          plot.height_px - kBottom};
  std::string out;
  out += text(f.left, 22, "title", plot.title);
  for (const auto& band : plot.bands) {
    const double from = f.px(std::clamp(band.from, f.x.low, f.x.high));
    const double to = f.px(std::clamp(band.to, f.x.low, f.x.high));
    out += rectangle("band b" + std::to_string(band.kind), from, f.top, std::max(to - from, 1.0),
                     f.bottom - f.top);
  }
  out += axes(plot, f);
  for (const auto& s : plot.series) out += polyline(s, f);
  out += legend(plot, f);
  return out;
}

std::string element(const Plot& plot, const std::string& more, const std::string& inside) {
  return "<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
         std::to_string(plot.width_px) + " " + std::to_string(plot.height_px) +
         "\" role=\"img\" aria-label=\"" + escaped(plot.title) + "\"" + more + ">\n" + inside +
         "</svg>\n";
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int most) {
  if (!std::isfinite(low) || !std::isfinite(high) || !(high > low) || most < 2) return {};
  const double rough = (high - low) / most;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1.0 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> ticks;
  const double first = std::ceil(low / step - 1e-9);
  for (int i = 0; i <= most + 1; ++i) {
    const double index = first + i;
    if (index * step > high + 1e-9 * step) break;
    ticks.push_back(index == 0.0 ? 0.0 : index * step);  // no negative zero
  }
  return ticks;
}

int tick_decimals(const std::vector<double>& ticks) {
  if (ticks.size() < 2) return 0;
  const double step = ticks[1] - ticks[0];
  return std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
}

std::string plot_style() {
  return R"(.plot{font-family:system-ui,"DejaVu Sans",sans-serif;width:100%;height:auto;
 --ink:#1f2328;--soft:#59636e;--grid:#e3e6ea;--zero:#9aa4ae;
 --c0:#0072b2;--c1:#d55e00;--c2:#009e73;--c3:#7a838c;--b0:#f3c623;--b1:#d1242f}
.plot .title{font-size:15px;font-weight:600;fill:var(--ink)}
.plot .tick,.plot .legend{font-size:12px;fill:var(--soft)}
.plot .label{font-size:12.5px;fill:var(--ink)}
.plot .grid{stroke:var(--grid);stroke-width:1}
.plot .zero{stroke:var(--zero);stroke-width:1.2}
.plot .line{fill:none;stroke-width:1.7;stroke-linejoin:round}
.plot .dashed{stroke-dasharray:5 4}
.plot .c0{stroke:var(--c0)} .plot .c1{stroke:var(--c1)}
.plot .c2{stroke:var(--c2)} .plot .c3{stroke:var(--c3)}
.plot .band{opacity:.22} .plot .b0{fill:var(--b0)} .plot .b1{fill:var(--b1)}
@media (prefers-color-scheme:dark){.plot{--ink:#e6edf3;--soft:#9da7b1;--grid:#30363d;--zero:#6e7681;
 --c0:#56b4e9;--c1:#f0883e;--c2:#3fc79a;--c3:#8b949e}}
)";
}

std::string plot_svg(const Plot& plot) { return element(plot, "", body(plot)); }

std::string plot_file(const Plot& plot) {
  const std::string size = " width=\"" + std::to_string(plot.width_px) + "\" height=\"" +
                           std::to_string(plot.height_px) + "\"";
  const std::string page =
      ".page{fill:#fff}@media (prefers-color-scheme:dark){.page{fill:#0d1117}}\n";
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" +
         element(plot, size,
                 "<style>" + plot_style() + page + "</style>\n" +
                     rectangle("page", 0, 0, plot.width_px, plot.height_px) + body(plot));
}

}  // namespace rovigo::app
