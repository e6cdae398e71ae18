#include "common/comparison/comparison_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/body/bones.h"

namespace chorus::comparison {
namespace {

using report::Figure;
using report::Judgement;
using report::Section;

constexpr std::size_t kMostInVerdict = 4;

std::string interval(const Estimate& estimate, double scale, int digits) {
  if (!std::isfinite(estimate.half)) return fmt::format("{:.{}f}", scale * estimate.mean, digits);
  return fmt::format("{:.{}f} +- {:.{}f}", scale * estimate.mean, digits, scale * estimate.half,
                     digits);
}

Figure figure(std::string key, std::string name, double value, std::string unit) {
  Figure out{std::move(key), std::move(name)};
  out.value = value;
  out.unit = std::move(unit);
  return out;
}

Figure estimated(std::string key, std::string name, const Estimate& estimate, double scale,
                 double least) {
  Figure out{std::move(key), std::move(name)};
  out.value = scale * estimate.mean;
  out.text = interval(estimate, scale, 2);
  out.judgement = estimate.differs(least) ? Judgement::Doubtful : Judgement::Good;
  return out;
}

Section alignment_section(const Comparison& comparison) {
  Section section{"alignment", "Clock and world"};
  section.paragraphs = {
      "B was brought to A's clock and into A's world before joints were compared. What had to be "
      "moved is a difference, too."};
  Figure lag = figure("lag", "lag", 1e3 * comparison.lag, "ms");
  lag.meaning = "added to B's times; from the motion itself";
  if (comparison.lag_sigma)
    lag.text = fmt::format("+- {:.1f} (one sigma)", 1e3 * *comparison.lag_sigma);
  else
    lag.text = "given: one clock";
  section.figures.push_back(lag);
  Figure yaw = estimated("yaw", "turn about the vertical", comparison.yaw, to_deg(1.0),
                         comparison.least_turn);
  yaw.unit = "deg";
  yaw.meaning = "of B's bodies against A's, before the transform";
  section.figures.push_back(yaw);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    Figure offset = estimated("offset_" + name, "trunk, " + name, comparison.offset[axis], 1e3,
                              comparison.least);
    offset.unit = "mm";
    offset.meaning = "A's trunk minus B's, before the transform";
    section.figures.push_back(offset);
  }
  return section;
}

Section joints_section(const PairComparison& pair) {
  Section section{fmt::format("person_{}", pair.a),
                  fmt::format("Person {} of A, person {} of B", pair.a, pair.b)};
  section.paragraphs = {
      fmt::format("{} frames in {:.1f} s. A minus B in A's world [mm], with the interval that "
                  "holds the true mean; limits of agreement (Bland and Altman) of the height.",
                  pair.frames, pair.seconds)};
  report::Table table{
      "Joints",
      {"joint", "x", "y", "z", "rms", "95 %", "drift per minute", "limits, height", "different"},
      {}};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!pair.joints[j]) continue;
    const JointDifference& d = *pair.joints[j];
    const std::string name(name_of(static_cast<JointId>(j)));
    table.rows.push_back({name, interval(d.offset[0], 1e3, 1), interval(d.offset[1], 1e3, 1),
                          interval(d.offset[2], 1e3, 1), fmt::format("{:.1f}", to_mm(d.rms)),
                          fmt::format("{:.1f}", to_mm(d.p95)), interval(d.drift, 1e3, 1),
                          fmt::format("{:.1f} to {:.1f}", to_mm(d.limit_low), to_mm(d.limit_high)),
                          d.differs ? "yes" : "no"});
    Figure rms = figure(name + ".rms", name, to_mm(d.rms), "mm");
    rms.meaning = "root mean square of the distance";
    rms.judgement = d.differs ? Judgement::Doubtful : Judgement::Good;
    section.figures.push_back(rms);
  }
  section.tables.push_back(std::move(table));
  return section;
}

Section over_time(const Comparison& comparison) {
  Section section{"time", "Over time"};
  report::Plot plot{"Mean distance of joints"};
  plot.x.label = "time [s]";
  plot.y.label = "distance [mm]";
  plot.y.least = 0.0;
  report::Series series{"A to B"};
  const double start = comparison.times.empty() ? 0.0 : comparison.times.front();
  for (std::size_t i = 0; i < comparison.times.size(); ++i) {
    series.x.push_back(comparison.times[i] - start);
    series.y.push_back(to_mm(comparison.distances[i]));
  }
  plot.series.push_back(std::move(series));
  section.plots.push_back(std::move(plot));
  return section;
}

std::string verdict_of(const Comparison& comparison) {
  if (comparison.differences.empty()) return "No difference was found.";
  std::string text = "Different: ";
  const std::size_t shown = std::min(kMostInVerdict, comparison.differences.size());
  for (std::size_t i = 0; i < shown; ++i) text += (i > 0 ? "; " : "") + comparison.differences[i];
  const std::size_t more = comparison.differences.size() - shown;
  if (more > 0) text += fmt::format("; and {} more", more);
  return text + ".";
}

}  // namespace

report::Report report_of(const Comparison& comparison, const Compared& what) {
  report::Report out;
  out.kind = "comparison";
  out.title = "Comparison of two recordings";
  out.verdict = verdict_of(comparison);
  out.judgement = comparison.differences.empty() ? Judgement::Good : Judgement::Doubtful;
  out.subject = {{"A", what.a}, {"B", what.b}};
  Section findings{"findings", "Differences"};
  findings.paragraphs = comparison.differences;
  if (findings.paragraphs.empty()) findings.paragraphs = {"None that chance does not explain."};
  for (const auto& [ids, side] : {std::pair{comparison.only_a, "A"}, {comparison.only_b, "B"}}) {
    for (const std::uint64_t id : ids)
      findings.paragraphs.push_back(fmt::format("Person {} is only in {}.", id, side));
  }
  for (const std::string& note : what.notes) findings.paragraphs.push_back("Note: " + note);
  out.sections = {std::move(findings), alignment_section(comparison)};
  for (const PairComparison& pair : comparison.pairs) out.sections.push_back(joints_section(pair));
  out.sections.push_back(over_time(comparison));
  return out;
}

}  // namespace chorus::comparison
