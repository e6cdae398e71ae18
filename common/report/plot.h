// A plot: series over two axes, with spans and limits drawn behind them.
//
// gnuplot draws it as SVG (decision 0125); this header knows only values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::report {

enum class Mark { Line, Dashes, Steps, Points, Bars };

struct Series {
  std::string name;  ///< In the legend; empty: not shown there.
  Mark mark = Mark::Line;
  std::vector<double> x = {};
  std::vector<double> y = {};  ///< As long as x.  Not finite: a gap in the line.
  /// A band from low to high around the line, each as long as x; empty: none.
  std::vector<double> low = {};
  std::vector<double> high = {};
};

/// A part of the x axis that is shaded, such as an annotated error.
struct Span {
  double from = 0.0;
  double to = 0.0;
};

/// A horizontal line with its name, such as a threshold.
struct Level {
  double y = 0.0;
  std::string name = {};
};

/// An axis from `least` to `most`; what is not given fits the series.
struct Axis {
  std::string label;  ///< With its unit: "time [s]".
  std::optional<double> least = std::nullopt;
  std::optional<double> most = std::nullopt;
  bool logarithmic = false;
  /// Named ticks at 0, 1, 2, ... instead of numbers, for bars; empty: numbers.
  std::vector<std::string> categories = {};
};

struct Plot {
  std::string title;
  Axis x = {};
  Axis y = {};
  std::vector<Series> series = {};
  std::vector<Span> spans = {};
  std::vector<Level> levels = {};
  bool same_scale = false;  ///< A metre is equally long in x and y, as on maps.
  int height = 300;         ///< [px]; the width is 760 px.
};

/// The gnuplot script that draws the plots, each as an SVG document of its own, on standard output.
/// Texts are quoted, so that nothing in them is executed.
[[nodiscard]] std::string gnuplot_script(const std::vector<Plot>& plots);

/// The SVG documents of the plots, drawn by one run of gnuplot; without width and height attributes
/// that a page could not shrink.  Unavailable when gnuplot is not installed or fails; the message
/// names the package.  Blocks for some 20 ms a plot.
[[nodiscard]] Result<std::vector<std::string>> drawn(const std::vector<Plot>& plots);

}  // namespace chorus::report
