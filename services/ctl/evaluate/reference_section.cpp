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

std::string shown_area(const std::optional<double>& area) {
  return area ? fmt::format("{:.2f}", *area) : "-";
}

/// What is said of a measure's contrast: "in faults 12 mm, else 11 mm; ROC 0.52".
std::string contrast_text(const FaultContrast& contrast, double scale, const char* unit) {
  if (!contrast.area) return "the reference shows no fault of this limb, or nothing else";
  return fmt::format("median in faults {:.0f} {}, else {:.0f} {}", scale * contrast.inside, unit,
                     scale * contrast.outside, unit);
}

/// The position error beside the orientation measure, and how well each shows the same faults.
std::vector<Figure> place_figures(const PlacedLimb& limb) {
  const std::string key = figure_key(limb.limb);
  const std::string name(words_for(limb.limb));
  Figure place{key + ".position_error", name + ": position error of the tracker"};
  place.unit = "mm";
  place.meaning = "distance of the limb's joints between tracker and reference, worlds aligned";
  if (limb.errors.empty()) {
    place.text = "tracker and reference show none of this limb's joints at one time";
    return {std::move(place)};
  }
  place.value = to_mm(limb.spread.median);
  place.text =
      fmt::format("median; nine tenths of the time at most {:.0f} mm", to_mm(limb.spread.p90));
  constexpr const char* kMeaning =
      "area under the ROC curve over the faults that the reference shows: 1 tells all, 0.5 is "
      "chance";
  return {std::move(place),
          {key + ".faults_by_orientation", name + ": faults shown by the sensor", limb.angle.area,
           "", contrast_text(limb.angle, to_deg(1.0), "deg"), kMeaning},
          {key + ".faults_by_position", name + ": faults shown by positions", limb.place.area, "",
           contrast_text(limb.place, to_mm(1.0), "mm"), kMeaning}};
}

report::Table fault_table(const RefereedTake& take) {
  report::Table out{"The same faults of the tracker by orientation and by position",
                    {"limb", "faults s", "sensor: else deg", "in faults deg", "ROC",
                     "position: else mm", "in faults mm", "ROC"},
                    {}};
  for (const PlacedLimb& limb : take.places) {
    if (limb.faults.empty()) continue;
    double length = 0.0;
    for (const Segment& each : limb.faults) length += each.length();
    out.rows.push_back(
        {std::string(words_for(limb.limb)), fmt::format("{:.1f}", length),
         fmt::format("{:.0f}", to_deg(limb.angle.outside)),
         fmt::format("{:.0f}", to_deg(limb.angle.inside)), shown_area(limb.angle.area),
         fmt::format("{:.0f}", to_mm(limb.place.outside)),
         fmt::format("{:.0f}", to_mm(limb.place.inside)), shown_area(limb.place.area)});
  }
  return out;
}

Plot place_plot(const PlacedLimb& limb) {
  Plot plot;
  plot.title = fmt::format("{}: position error of the tracker", words_for(limb.limb));
  plot.x.label = "time [s]";
  plot.y.label = "distance [mm]";
  report::Series series{"limb's joints", report::Mark::Line};
  for (const auto& each : limb.errors) {
    series.x.push_back(each.time);
    series.y.push_back(to_mm(each.value));
  }
  plot.series.push_back(std::move(series));
  for (const Segment& each : limb.faults) plot.spans.push_back({each.begin, each.end});
  return plot;
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
      "sensor disagree. Twist counts where tracker and reference both show it.",
      "Position errors are what trackers are usually judged by. A limb that is turned about its "
      "bone "
      "leaves its joints where they are: there they show nothing. Shaded in their plots: the "
      "tracker's limb is farther than tau from the reference's."};
  for (std::size_t i = 0; i < take.limbs.size(); ++i) {
    const RefereedLimb& limb = take.limbs[i];
    out.figures.push_back(error_figure(limb, "tracker", limb.tracker_spread));
    out.figures.push_back(error_figure(limb, "sensor", limb.sensor_spread));
    for (Figure& each : place_figures(take.places[i])) out.figures.push_back(std::move(each));
    out.figures.push_back(right_figure(limb, Right::Tracker, "tracker"));
    out.figures.push_back(right_figure(limb, Right::Sensor, "sensor"));
    out.plots.push_back(error_plot(limb, tau));
    if (!take.places[i].errors.empty()) out.plots.push_back(place_plot(take.places[i]));
  }
  auto faults = fault_table(take);
  if (!faults.rows.empty()) out.tables.push_back(std::move(faults));
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
