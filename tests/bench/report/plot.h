// A small chart as SVG for the docs: axes with round ticks, lines, points, a legend.
//
// Dark ink on its own white background, so that it is legible on light and dark pages; colours that
// colour-blind people can distinguish.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"

namespace chorus::bench {

/// Bars stand on the lower axis and are equally wide in all series: shift their x to put them side
/// by side.
enum class Mark { Line, Dashes, Dots, Crosses, Bars };

struct Series {
  std::string name;  ///< Shown in the legend; empty: not shown there.
  Mark mark = Mark::Line;
  std::vector<Eigen::Vector2d> points;  ///< Not finite: a gap in the line.
  int colour = -1;  ///< Index in the palette, so that series can share a colour; -1: automatic.
};

/// An axis from `least` to `most`; if they are equal, it fits the data.
struct Axis {
  std::string label;  ///< With its unit: "true yaw [deg]".
  double least = 0.0;
  double most = 0.0;
  double step = 0.0;  ///< Distance of ticks; 0: a round value.
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  bool same_scale = false;  ///< A metre is equally long in x and y, as on maps.
};

/// The whole document; without series or finite points the axes are empty.
[[nodiscard]] std::string svg_of(const Plot& plot);

/// Writes svg_of() to DIR/NAME.svg; DIR must exist.
[[nodiscard]] Result<void> write_svg(const Plot& plot, const std::string& folder,
                                     const std::string& name);

}  // namespace chorus::bench
