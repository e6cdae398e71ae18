#include "services/ctl/evaluate/reference_section.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/base/units.h"

namespace chorus::ctl {
namespace {

using namespace evaluation;
using report::Figure;
using report::Plot;

Figure error_figure(const RefereedLimb& limb, const char* whose, const ErrorSpread& spread) {
  return {figure_key(limb.limb) + "." + whose + "_error",
          fmt::format("{}: error of the {}", words_for(limb.limb), whose),
          to_deg(spread.median),
          "deg",
          fmt::format("median; nine tenths of the time at most {:.1f} deg", to_deg(spread.p90)),
          fmt::format("angle between the limb by the {} and by the reference", whose)};
}

Figure right_figure(const RefereedLimb& limb, Right right, const char* whose) {
  const auto all = limb.disagreements();
  const auto own = limb.instants[static_cast<std::size_t>(right)];
  Figure out{figure_key(limb.limb) + "." + whose + "_right",
             fmt::format("{}: {} right in disagreements", words_for(limb.limb), whose)};
  out.unit = "%";
  out.meaning = fmt::format(
      "share of the time of disagreement in which the {} is nearer to the "
      "reference, and within tau of it",
      whose);
  if (all > 0)
    out.value = 100.0 * static_cast<double>(own) / static_cast<double>(all);
  else
    out.text = "they never disagree while the reference shows the limb";
  return out;
}

std::string errs(Right right) {
  switch (right) {
    case Right::Tracker:
      return "the sensor errs";
    case Right::Sensor:
      return "the tracker errs";
    case Right::Neither:
      break;
  }
  return "both err";
}

report::Table segment_table(const RefereedTake& take) {
  report::Table out{
      "Who is right where tracker and sensor disagree",
      {"limb", "from s", "to s", "tracker off deg", "sensor off deg", "by the reference"},
      {}};
  for (const RefereedLimb& limb : take.limbs)
    for (const RefereedSegment& each : limb.segments)
      out.rows.push_back(
          {std::string(words_for(limb.limb)), fmt::format("{:.1f}", each.segment.begin),
           fmt::format("{:.1f}", each.segment.end), fmt::format("{:.0f}", to_deg(each.tracker)),
           fmt::format("{:.0f}", to_deg(each.sensor)), errs(each.right)});
  return out;
}

Plot error_plot(const RefereedLimb& limb, double tau) {
  Plot plot;
  plot.title = fmt::format("{}: tracker and sensor against the reference", words_for(limb.limb));
  plot.x.label = "time [s]";
  plot.y = {"angle [deg]", 0.0, 180.0};
  for (const auto& [name, errors, mark] :
       {std::tuple{"tracker", &limb.tracker, report::Mark::Line},
        std::tuple{"sensor", &limb.sensor, report::Mark::Dashes}}) {
    report::Series series{name, mark};
    for (const auto& each : *errors) {
      series.x.push_back(each.time);
      series.y.push_back(to_deg(each.value.angle));
    }
    plot.series.push_back(std::move(series));
  }
  for (const RefereedSegment& each : limb.segments)
    plot.spans.push_back({each.segment.begin, each.segment.end});
  plot.levels = {{to_deg(tau), "tau"}};
  return plot;
}

}  // namespace

std::string figure_key(inertial::Limb limb) {
  std::string key(words_for(limb));
  std::ranges::replace(key, ' ', '_');
  return key;
}

report::Section reference_section(const RefereedTake& take, double tau) {
  report::Section out{"reference", "Tracker and sensors against the reference"};
  out.paragraphs = {
      fmt::format(
          "{}: its time {:+.3f} s +- {:.1f} ms is the tracker's (bones turn alike, correlation "
          "{:.2f}); {} joints that both show are {:.0f} mm apart (rms) once the worlds are one.",
          take.file, take.shift.shift, 1e3 * take.shift.sigma, take.shift.correlation, take.joints,
          to_mm(take.rms)),
      "Joints of markers and of a tracker do not sit in the same places. What is constant of that "
      "is in both errors, because the sensor was calibrated by the tracker. Shaded: tracker and "
      "sensor disagree. Twist counts where tracker and reference both show it."};
  for (const RefereedLimb& limb : take.limbs) {
    out.figures.push_back(error_figure(limb, "tracker", limb.tracker_spread));
    out.figures.push_back(error_figure(limb, "sensor", limb.sensor_spread));
    out.figures.push_back(right_figure(limb, Right::Tracker, "tracker"));
    out.figures.push_back(right_figure(limb, Right::Sensor, "sensor"));
    out.plots.push_back(error_plot(limb, tau));
  }
  auto segments = segment_table(take);
  if (!segments.rows.empty()) out.tables.push_back(std::move(segments));
  return out;
}

std::string reference_verdict(const RefereedTake& take) {
  std::array<std::size_t, 3> counts{};
  for (const RefereedLimb& limb : take.limbs)
    for (const RefereedSegment& each : limb.segments)
      ++counts[static_cast<std::size_t>(each.right)];
  const auto of = [&](Right right) { return counts[static_cast<std::size_t>(right)]; };
  const std::size_t all = counts[0] + counts[1] + counts[2];
  if (all == 0) return "The reference shows no disagreement of tracker and sensors.";
  return fmt::format(
      "Of {} disagreements that the reference shows, the tracker errs in {}, the sensor in {}, "
      "both in {}.",
      all, of(Right::Sensor), of(Right::Tracker), of(Right::Neither));
}

}  // namespace chorus::ctl
