#include "tests/bench/model/model_plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "tests/bench/model/mannequin.h"
#include "tests/bench/report/plot.h"

namespace chorus::bench {
namespace {

using enum JointId;
using Samples = std::vector<MannequinSample>;

constexpr std::array kCentre{Neck, SpineShoulder, Head, SpineMid, SpineBase};
constexpr double kBin = deg(10);
constexpr std::size_t kMaxPoints = 360;  // keeps the file small

std::string name(JointId id) { return std::string(name_of(id)); }

/// At most `kMaxPoints` samples, evenly chosen; for single positions, not for differences.
Samples thinned(const Samples& samples) {
  const std::size_t step = samples.size() / kMaxPoints + 1;
  Samples kept;
  for (std::size_t i = 0; i < samples.size(); i += step) kept.push_back(samples[i]);
  return kept;
}

/// Yaw of a left-right line, 0 = facing the sensor [rad].
double line_yaw(const Skeleton<SensorSpace>& body, JointId left, JointId right) {
  const Eigen::Vector3d to_left = body[left].position - body[right].position;
  return std::atan2(to_left.z(), -to_left.x());
}

/// Otto Fig. 6.
Plot yaw_shown(const Samples& samples) {
  Plot plot{"Yaw shown by the simulated sensor (Otto Fig. 6)",
            {"true yaw [deg]", 0, 360, 45},
            {"yaw shown [deg]", -100, 180},
            {},
            false};
  Series exact{"true", Mark::Dashes, {}, 6};
  Series shoulders{"shoulders", Mark::Dots, {}, 0};
  Series hips{"hips", Mark::Dots, {}, 1};
  for (const MannequinSample& each : samples) {
    const double angle = to_deg(each.angle);
    exact.points.emplace_back(angle, to_deg(wrap_angle(each.angle)));
    const double sign = shown_facing(each.exact) * wrap_angle(each.angle) < 0 ? -1.0 : 1.0;
    shoulders.points.emplace_back(angle, sign * to_deg(shown_facing(each.shown)));
    hips.points.emplace_back(angle, sign * to_deg(line_yaw(each.shown, HipLeft, HipRight)));
  }
  const Series right{"Otto: right up to here", Mark::Crosses, {{40, 40}, {320, -40}}, 3};
  const Series flips{"Otto: flip; back between", Mark::Crosses, {{130, 0}, {260, 0}, {320, 0}}, 4};
  plot.series = {exact, shoulders, hips, right, flips};
  return plot;
}

/// Otto Fig. 5: shoulders from above, half a turn.
Plot shoulders_from_above(const Samples& samples) {
  Plot plot{
      "Shoulders from above, 0 to 180 deg (Otto Fig. 5)", {"lateral [m]"}, {"depth [m]"}, {}, true};
  Series left{"left shoulder", Mark::Dots, {}, 0};
  Series right{"right shoulder", Mark::Dots, {}, 1};
  Series circle{"true circle", Mark::Dashes, {}, 6};
  for (const MannequinSample& each : samples) {
    if (each.angle > deg(180)) break;
    const auto above = [](const Joint& joint) {
      return Eigen::Vector2d(joint.position.x(), joint.position.z());
    };
    left.points.push_back(above(each.shown[ShoulderLeft]));
    right.points.push_back(above(each.shown[ShoulderRight]));
    circle.points.push_back(above(each.exact[ShoulderLeft]));
  }
  plot.series = {circle,
                 left,
                 right,
                 {"Otto: the right one jumps", Mark::Crosses, {{-0.05, 2.2}, {-0.15, 2.4}}, 3}};
  return plot;
}

/// Otto Fig. 7.
Plot jitter_by_angle(const Samples& samples) {
  Plot plot{"Jitter from frame to frame (Otto Fig. 7)",
            {"true yaw [deg]", 0, 360, 45},
            {"mean displacement [mm]", 0, 6},
            {},
            false};
  for (std::size_t i = 0; i < kCentre.size(); ++i) {
    Series series{name(kCentre[i]), Mark::Line, {}, static_cast<int>(i)};
    for (double from = 0; from < deg(360) - 1e-9; from += kBin) {
      series.points.emplace_back(to_deg(from + 0.5 * kBin),
                                 to_mm(jitter(samples, kCentre[i], from, from + kBin)));
    }
    plot.series.push_back(std::move(series));
  }
  plot.series.push_back({"Otto: SpineBase below", Mark::Crosses, {{90, 4.1}, {270, 4.1}}, 4});
  plot.series.push_back({"Otto: Neck below", Mark::Crosses, {{0, 0.2}, {180, 0.5}, {360, 0.2}}, 0});
  return plot;
}

/// Otto Fig. 8: centre joints seen from above while the body swings about a mount behind its back.
Plot circle_from_above(const Samples& swing) {
  Plot plot{"Centre joints from above, 0 to 85 deg (Otto Fig. 8)",
            {"lateral [m]"},
            {"depth [m]"},
            {},
            true};
  Series circle{"true circle", Mark::Dashes, {}, 6};
  for (const MannequinSample& each : swing) {
    circle.points.emplace_back(each.exact[Neck].position.x(), each.exact[Neck].position.z());
  }
  plot.series.push_back(std::move(circle));
  for (std::size_t i = 0; i < kCentre.size(); ++i) {
    Series series{name(kCentre[i]), Mark::Line, {}, static_cast<int>(i)};
    for (const MannequinSample& each : swing) {
      const Eigen::Vector3d& position = each.shown[kCentre[i]].position;
      series.points.emplace_back(position.x(), position.z());
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot errors_by_angle(const Samples& swing) {
  Plot plot{"Distance from the truth, 0 to 85 deg (Otto Fig. 8)",
            {"true yaw [deg]", 0, 90},
            {"error [mm]"},
            {},
            false};
  for (std::size_t i = 0; i < kCentre.size(); ++i) {
    Series series{name(kCentre[i]), Mark::Line, {}, static_cast<int>(i)};
    for (const MannequinSample& each : swing) {
      series.points.emplace_back(
          to_deg(each.angle),
          to_mm((each.shown[kCentre[i]].position - each.exact[kCentre[i]].position).norm()));
    }
    plot.series.push_back(std::move(series));
  }
  plot.series.push_back({"Otto: Head leaves here", Mark::Crosses, {{45, 0}}, 2});
  plot.series.push_back({"Otto: SpineBase leaves here", Mark::Crosses, {{60, 0}}, 4});
  return plot;
}

Plot table1_bars(const std::vector<TableOneBar>& table1) {
  constexpr double kApart = 5.0;  // offset of a scenario's two bars from its middle [deg]
  Plot plot{"Repeatability of the paper's registration (Otto Table 1)",
            {"angle between the sensors [deg]", -15, 195, 45},
            {"mean distance from the centre [mm]", 0, 40},
            {},
            false};
  Series otto{"Otto Table 1", Mark::Bars, {}, 1};
  Series ours{"profile A, median", Mark::Bars, {}, 0};
  Series range{"profile A, all set-ups", Mark::Line, {}, 6};
  for (const TableOneBar& each : table1) {
    otto.points.emplace_back(each.angle_deg - kApart, each.otto);
    ours.points.emplace_back(each.angle_deg + kApart, each.median);
    range.points.emplace_back(each.angle_deg + kApart, each.least);
    range.points.emplace_back(each.angle_deg + kApart, std::min(each.most, plot.y.most));
    range.points.emplace_back(Eigen::Vector2d::Constant(std::nan("")));
  }
  plot.series = {otto, ours, range};
  return plot;
}

}  // namespace

Result<void> draw_figures(const std::string& folder, std::uint64_t seed,
                          const std::vector<TableOneBar>& table1) {
  const auto profile = synthetic::kinect::nominal_profile("A");
  const Samples turn = turn_full(profile, seed);
  const Samples swing = thinned(swing_85(profile, seed));
  std::vector<std::pair<const char*, Plot>> figures{
      {"mannequin-yaw", yaw_shown(thinned(turn))},
      {"mannequin-shoulders", shoulders_from_above(thinned(turn))},
      {"mannequin-jitter", jitter_by_angle(turn)},
      {"mannequin-circle", circle_from_above(swing)},
      {"mannequin-errors", errors_by_angle(swing)}};
  if (!table1.empty()) figures.emplace_back("table1", table1_bars(table1));
  for (const auto& [file, plot] : figures) {
    if (const Result<void> written = write_svg(plot, folder, file); !written) return written;
  }
  return {};
}

}  // namespace chorus::bench
