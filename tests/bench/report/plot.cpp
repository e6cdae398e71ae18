#include "tests/bench/report/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "common/http/html.h"

namespace chorus::bench {
namespace {

constexpr double kWidth = 860;
constexpr double kHeight = 440;
constexpr double kLeft = 70;
constexpr double kRight = 590;  // the legend is right of this
constexpr double kTop = 40;
constexpr double kBottom = 385;
constexpr double kLegendStep = 20;
constexpr double kAimedTicks = 6;
constexpr double kBarWidth = 26;
constexpr double kPadding = 0.05;  // fraction of the data's range, if the axis follows the data
constexpr int kMaxTicks = 50;

// Okabe and Ito: distinguishable for colour-blind people, too.
constexpr std::array<std::string_view, 7> kPalette{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                   "#b8860b", "#56b4e9", "#333333"};

/// A step between ticks: 1, 2 or 5 times a power of ten.
double round_step(double range) {
  const double rough = range / kAimedTicks;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double share = rough / power;
  return power * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

/// The axis as given, or fitted to the data.
Axis fitted(const Axis& axis, const Plot& plot, int dimension) {
  if (axis.least < axis.most) return axis;
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const Series& series : plot.series) {
    for (const Eigen::Vector2d& point : series.points) {
      if (!point.allFinite()) continue;
      least = std::min(least, point[dimension]);
      most = std::max(most, point[dimension]);
    }
  }
  if (!(least <= most)) return {axis.label, 0.0, 1.0, 0.0};
  const double room = most > least ? kPadding * (most - least) : std::max(1e-9, std::abs(most));
  return {axis.label, least - room, most + room, axis.step};
}

/// Maps data to picture coordinates.
struct Scale {
  Axis x, y;

  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector2d& point) const {
    return {kLeft + (point.x() - x.least) / (x.most - x.least) * (kRight - kLeft),
            kBottom - (point.y() - y.least) / (y.most - y.least) * (kBottom - kTop)};
  }
  [[nodiscard]] bool shows(const Eigen::Vector2d& point) const {
    return point.allFinite() && point.x() >= x.least && point.x() <= x.most &&
           point.y() >= y.least && point.y() <= y.most;
  }
};

void widen(Axis& axis, double range) {
  const double middle = 0.5 * (axis.least + axis.most);
  axis.least = middle - 0.5 * range;
  axis.most = middle + 0.5 * range;
}

Scale scale_of(const Plot& plot) {
  Scale scale{fitted(plot.x, plot, 0), fitted(plot.y, plot, 1)};
  if (!plot.same_scale) return scale;
  const double per_unit = std::min((kRight - kLeft) / (scale.x.most - scale.x.least),
                                   (kBottom - kTop) / (scale.y.most - scale.y.least));
  widen(scale.x, (kRight - kLeft) / per_unit);
  widen(scale.y, (kBottom - kTop) / per_unit);
  return scale;
}

std::string text(double x, double y, std::string_view how, std::string_view what) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, how,
                     http::escaped_html(what));
}

std::string line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::string_view colour) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", from.x(),
      from.y(), to.x(), to.y(), colour);
}

std::vector<double> ticks_of(const Axis& axis) {
  std::vector<double> ticks;
  const double step = axis.step > 0 ? axis.step : round_step(axis.most - axis.least);
  const double first = std::ceil(axis.least / step - 1e-9);
  for (int i = 0; i < kMaxTicks; ++i) {
    const double tick = (first + i) * step;
    if (tick > axis.most + 1e-9 * step) break;
    ticks.push_back(std::abs(tick) < 1e-9 * step ? 0.0 : tick);
  }
  return ticks;
}

std::string axes(const Scale& scale) {
  constexpr std::string_view kGrid = "#dddddd";
  std::string out;
  for (const double tick : ticks_of(scale.x)) {
    const double x = scale.at({tick, scale.y.least}).x();
    out += line({x, kTop}, {x, kBottom}, kGrid);
    out += text(x, kBottom + 18, "text-anchor=\"middle\"", fmt::format("{:.6g}", tick));
  }
  for (const double tick : ticks_of(scale.y)) {
    const double y = scale.at({scale.x.least, tick}).y();
    out += line({kLeft, y}, {kRight, y}, kGrid);
    out += text(kLeft - 8, y + 4, "text-anchor=\"end\"", fmt::format("{:.6g}", tick));
  }
  out += line({kLeft, kBottom}, {kRight, kBottom}, "#333333");
  out += line({kLeft, kTop}, {kLeft, kBottom}, "#333333");
  out += text(0.5 * (kLeft + kRight), kBottom + 40, "text-anchor=\"middle\"", scale.x.label);
  const double middle = 0.5 * (kTop + kBottom);
  return out +
         text(16, middle,
              fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 16 {:.1f})\"", middle),
              scale.y.label);
}

std::string mark(const Eigen::Vector2d& at, Mark kind, std::string_view colour) {
  if (kind == Mark::Dots) {
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.2\" fill=\"{}\"/>\n", at.x(),
                       at.y(), colour);
  }
  return fmt::format(
      "<path d=\"M{:.1f} {:.1f}l10 10m0 -10l-10 10\" stroke=\"{}\" "
      "stroke-width=\"2.5\" fill=\"none\"/>\n",
      at.x() - 5, at.y() - 5, colour);
}

std::string bar(const Eigen::Vector2d& top, double bottom, double width, std::string_view colour) {
  return fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
      top.x() - 0.5 * width, top.y(), width, bottom - top.y(), colour);
}

bool is_line(Mark kind) { return kind == Mark::Line || kind == Mark::Dashes; }

/// The series as a line, interrupted at points that are not finite or lie outside the axes.
std::string drawn_line(const Series& series, const Scale& scale, std::string_view colour) {
  std::string path;
  bool down = false;
  for (const Eigen::Vector2d& point : series.points) {
    if (!scale.shows(point)) {
      down = false;
      continue;
    }
    const Eigen::Vector2d at = scale.at(point);
    path += fmt::format("{}{:.1f} {:.1f}", down ? 'L' : 'M', at.x(), at.y());
    down = true;
  }
  const std::string_view dashes =
      series.mark == Mark::Dashes ? " stroke-dasharray=\"6 4\"" : std::string_view{};
  return fmt::format("<path d=\"{}\" stroke=\"{}\" stroke-width=\"1.8\" fill=\"none\"{}/>\n", path,
                     colour, dashes);
}

std::string drawn(const Series& series, const Scale& scale, std::string_view colour) {
  if (is_line(series.mark)) return drawn_line(series, scale, colour);
  std::string out;
  for (const Eigen::Vector2d& point : series.points) {
    if (!scale.shows(point)) continue;
    const Eigen::Vector2d at = scale.at(point);
    out += series.mark == Mark::Bars ? bar(at, kBottom, kBarWidth, colour)
                                     : mark(at, series.mark, colour);
  }
  return out;
}

std::string legend_entry(const Series& series, double y, std::string_view colour) {
  const double x = kRight + 18;
  std::string sign;
  if (is_line(series.mark)) {
    sign = fmt::format("<path d=\"M{:.1f} {:.1f}h22\" stroke=\"{}\" stroke-width=\"2.5\"{}/>\n", x,
                       y, colour, series.mark == Mark::Dashes ? " stroke-dasharray=\"6 4\"" : "");
  } else if (series.mark == Mark::Bars) {
    sign = bar({x + 11, y - 5}, y + 5, 10, colour);
  } else {
    sign = mark({x + 11, y}, series.mark, colour);
  }
  return sign + text(x + 30, y + 4, "", series.name);
}

}  // namespace

std::string svg_of(const Plot& plot) {
  const Scale scale = scale_of(plot);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222222\">\n"
      "<rect width=\"{0}\" height=\"{1}\" rx=\"6\" fill=\"#ffffff\"/>\n",
      kWidth, kHeight);
  out += text(kLeft, 24, "font-size=\"15\" font-weight=\"bold\"", plot.title);
  out += axes(scale);
  double y = kTop + 10;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& series = plot.series[i];
    const std::size_t place = series.colour < 0 ? i : static_cast<std::size_t>(series.colour);
    const std::string_view colour = kPalette[place % kPalette.size()];
    out += drawn(series, scale, colour);
    if (series.name.empty()) continue;
    out += legend_entry(series, y, colour);
    y += kLegendStep;
  }
  return out + "</svg>\n";
}

Result<void> write_svg(const Plot& plot, const std::string& folder, const std::string& name) {
  const std::string path = folder + "/" + name + ".svg";
  std::ofstream file(path);
  file << svg_of(plot);
  if (!file.flush()) return fail(ErrorCode::Unavailable, path, "cannot be written");
  return {};
}

}  // namespace chorus::bench
