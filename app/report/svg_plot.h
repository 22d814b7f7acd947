#pragma once
// Line plots over time as SVG, written by hand: no library, no network, readable light and dark.

#include <string>
#include <vector>

namespace rovigo::app {

struct PlotSeries {
  std::string name;
  std::vector<double> x;  ///< increasing
  std::vector<double> y;  ///< as many as x; values that are not finite leave a gap
  int color = 0;          ///< 0 blue, 1 vermilion, 2 green, 3 grey; told apart by the colour-blind
  bool dashed = false;
};

/// A stretch of x shaded behind the lines.
struct PlotBand {
  double from = 0.0;
  double to = 0.0;
  int kind = 0;      ///< 0 amber, 1 red
  std::string name;  ///< for the legend; bands with the same name share an entry
};

struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;
  std::vector<PlotBand> bands;
  /// The y axis spans at least this much, so that noise does not look like failure; centred.
  double least_y_span = 0.0;
  int width_px = 640;
  int height_px = 300;
};

/// Round tick positions (1, 2 or 5 times a power of ten apart) covering [low, high] from within.
/// At least two for any finite range; empty when the range is not finite.
std::vector<double> round_ticks(double low, double high, int most);
/// Decimals that tell neighbouring ticks apart.
int tick_decimals(const std::vector<double>& ticks);

/// The look of every plot, for a page that holds several.
std::string plot_style();
/// An <svg> element for a page that includes plot_style().
std::string plot_svg(const Plot& plot);
/// A file of its own.
std::string plot_file(const Plot& plot);

}  // namespace rovigo::app
