// A small chart as SVG: axes with round ticks, lines, points, a legend.  For figures in docs.
//
// Dark ink on its own white sheet, so that it reads on a light and on a dark page; colours that
// colour-blind people tell apart.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"

namespace chorus::bench {

/// Bars stand on the lower axis, as wide for every series: set their x apart to put them side by
/// side.
enum class Mark { Line, Dashes, Dots, Crosses, Bars };

struct Series {
  std::string name;  ///< In the legend; empty: not named there.
  Mark mark = Mark::Line;
  std::vector<Eigen::Vector2d> points;  ///< Not finite: a gap in the line.
  int colour = -1;  ///< Place in the palette, to let series share a colour; -1: its own place.
};

/// An axis from `least` to `most`; equal: what the data needs.
struct Axis {
  std::string label;  ///< With its unit: "true yaw [deg]".
  double least = 0.0;
  double most = 0.0;
  double step = 0.0;  ///< From tick to tick; 0: a round one.
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  bool same_scale = false;  ///< A metre is as long in x as in y: maps.
};

/// The whole document; no series and nothing finite give empty axes.
[[nodiscard]] std::string svg_of(const Plot& plot);

/// Writes svg_of() to DIR/NAME.svg; DIR must exist.
[[nodiscard]] Result<void> write_svg(const Plot& plot, const std::string& folder,
                                     const std::string& name);

}  // namespace chorus::bench
