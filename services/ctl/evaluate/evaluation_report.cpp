#include "services/ctl/evaluate/evaluation_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"

namespace chorus::ctl {
namespace {

using namespace evaluation;
using report::Figure;
using report::Judgement;
using report::Plot;
using report::Section;

std::string capital(std::string_view words) {
  std::string out(words);
  if (!out.empty())
    out.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(out.front())));
  return out;
}

std::vector<report::Span> spans_of(const std::vector<Segment>& segments) {
  std::vector<report::Span> out;
  for (const Segment& each : segments) out.push_back({each.begin, each.end});
  return out;
}

/// Fig. 5: the distance over time, tau, and where it is exceeded.
Plot distance_plot(const JudgedLimb& limb, double tau) {
  Plot plot;
  plot.title = capital(words_for(limb.limb)) + ": distance of tracker and sensor";
  plot.x.label = "time [s]";
  plot.y = {"angle [deg]", 0.0, 180.0};
  report::Series angle{"d_quat", report::Mark::Line};
  report::Series swing{"swing", report::Mark::Dashes};
  for (const auto& each : limb.errors) {
    angle.x.push_back(each.time);
    angle.y.push_back(to_deg(each.value.angle));
    swing.x.push_back(each.time);
    swing.y.push_back(to_deg(each.value.swing));
  }
  plot.series = {std::move(angle), std::move(swing)};
  plot.spans = spans_of(limb.detected);
  plot.levels = {{to_deg(tau), "tau"}, {to_deg(limb.own_tau), "the limb's own tau"}};
  return plot;
}

/// Fig. 9: the angular rates of both worlds, in which the same errors hardly show.
Plot rate_plot(const JudgedLimb& limb) {
  Plot plot;
  plot.title = capital(words_for(limb.limb)) + ": angular rates";
  plot.x.label = "time [s]";
  plot.y.label = "rate [deg/s]";
  for (const auto& [name, signal] :
       {std::pair{"tracker", &limb.tracked_rate}, {"sensor", &limb.sensed_rate}}) {
    report::Series series{name, report::Mark::Line};
    for (const auto& each : *signal) {
      series.x.push_back(each.time);
      series.y.push_back(to_deg(each.value));
    }
    plot.series.push_back(std::move(series));
  }
  plot.spans = spans_of(limb.detected);
  return plot;
}

std::string listed(const std::vector<Segment>& segments) {
  std::string out;
  for (const Segment& each : segments) {
    if (out.size() > 200) return out + " ...";
    out += fmt::format("{}{:.1f}-{:.1f} s", out.empty() ? "" : ", ", each.begin, each.end);
  }
  return out.empty() ? "none" : out;
}

/// Said where a limb is judged in the seconds that calibrated it, too.
std::string calibrated_by(const JudgedLimb& limb) {
  if (limb.errors.empty() || limb.errors.front().time >= limb.calibrated_to) return {};
  return fmt::format("; made from the take up to {:.1f} s, in which it agrees a little better",
                     limb.calibrated_to);
}

std::vector<Figure> figures_of(const JudgedLimb& limb, const EvaluationInputs& inputs) {
  const std::string key = figure_key(limb.limb);
  const std::string name(words_for(limb.limb));
  const double percent = error_percent(limb);
  const bool good = percent <= inputs.most_percent;
  return {
      Figure{key + ".in_error", name + " in error", percent, "%", listed(limb.detected),
             "share of the time in which tracker and sensor differ by more than tau",
             fmt::format("at most {:.0f} %", inputs.most_percent),
             "look at the take in these seconds: " + listed(limb.detected),
             good ? Judgement::Good : Judgement::Bad},
      Figure{
          key + ".noise", name + " noise", to_deg(limb.floor.mean), "deg",
          fmt::format("+- {:.1f} deg; the paper's torso: 14.4 +- 7.7", to_deg(limb.floor.spread)),
          "mean distance where it is below tau: sensors, skin and calibration together"},
      Figure{key + ".calibration", name + " calibration", to_deg(limb.calibration.prediction_sigma),
             "deg",
             fmt::format("residual {:.1f} deg; sensor {}; heading {:.0f} deg{}",
                         to_deg(limb.calibration.residual), limb.calibration.sensor,
                         to_deg(limb.calibration.heading), calibrated_by(limb)),
             "standard error of what the sensor predicts, by heading and mount", "at most 10 deg"},
      Figure{key + ".own_tau", name + " own tau", to_deg(limb.own_tau), "deg",
             listed(limb.detected_by_own),
             "the threshold from this limb's calibration, and the errors by it"},
  };
}

std::string shown_share(const std::optional<double>& share) {
  return share ? fmt::format("{:.2f}", *share) : "-";
}

/// Fig. 8 (a): precision, recall and F at tau, and the agreement of two annotators.
report::Table score_table(const evaluation::Judgement& found, const EvaluationInputs& inputs) {
  report::Table table{
      "Automatic against manual annotations, tau as above",
      {"limb", "annotator", "precision", "recall", "F", "segment precision", "segment recall"},
      {}};
  for (const JudgedLimb& limb : found.limbs) {
    std::vector<double> times;
    for (const auto& each : limb.errors) times.push_back(each.time);
    for (std::size_t a = 0; a < inputs.annotations.size(); ++a) {
      const auto truth = segments_of(inputs.annotations[a], limb.limb);
      const Counts frames = frame_counts(times, limb.detected, truth);
      const Counts segments = segment_counts(limb.detected, truth);
      table.rows.push_back({std::string(words_for(limb.limb)), inputs.annotators[a],
                            shown_share(frames.precision()), shown_share(frames.recall()),
                            shown_share(frames.f()), shown_share(segments.precision()),
                            shown_share(segments.recall())});
    }
    if (inputs.annotations.size() == 2)
      table.rows.push_back({std::string(words_for(limb.limb)), "kappa of both",
                            shown_share(kappa(times, segments_of(inputs.annotations[0], limb.limb),
                                              segments_of(inputs.annotations[1], limb.limb)))});
  }
  return table;
}

/// Fig. 7: automatic and manual annotations as bars over time.
Plot bars_plot(const evaluation::Judgement& found, const EvaluationInputs& inputs) {
  Plot plot;
  plot.title = "Errors over time: automatic, then annotators, limb by limb";
  plot.x.label = "time [s]";
  plot.y.label = "row";
  double row = 0.0;
  const auto add = [&](const std::string& name, const std::vector<Segment>& segments) {
    report::Series series{name, report::Mark::Line};
    for (const Segment& each : segments) {
      series.x.insert(series.x.end(), {each.begin, each.end, each.end});
      series.y.insert(series.y.end(), {row, row, std::nan("")});
    }
    row += 1.0;
    if (!segments.empty()) plot.series.push_back(std::move(series));
  };
  for (const JudgedLimb& limb : found.limbs) {
    add(std::string(words_for(limb.limb)), limb.detected);
    for (std::size_t a = 0; a < inputs.annotations.size(); ++a)
      add(std::string(words_for(limb.limb)) + ", " + inputs.annotators[a],
          segments_of(inputs.annotations[a], limb.limb));
  }
  return plot;
}

/// Fig. 8 (b), (c): precision, recall and F over tau.
Plot tau_plot(const evaluation::Judgement& found, const EvaluationInputs& inputs,
              inertial::LimbGroup group) {
  Plot plot;
  plot.title = "Precision, recall and F over tau: " + std::string(name_of(group));
  plot.x.label = "tau [deg]";
  plot.y = {"share", 0.0, 1.0};
  for (std::size_t a = 0; a < inputs.annotations.size(); ++a) {
    const auto rows = over_tau(found.limbs, inputs.annotations[a], group);
    using Take = std::optional<double> (Counts::*)() const;
    for (const auto& [name, take] : {std::pair<const char*, Take>{"precision", &Counts::precision},
                                     {"recall", &Counts::recall},
                                     {"F", &Counts::f}}) {
      report::Series series{fmt::format("{}, {}", name, inputs.annotators[a]),
                            a == 0 ? report::Mark::Line : report::Mark::Dashes};
      for (const TauRow& row : rows) {
        series.x.push_back(to_deg(row.tau));
        series.y.push_back((row.counts.*take)().value_or(std::nan("")));
      }
      plot.series.push_back(std::move(series));
    }
  }
  return plot;
}

Section annotation_section(const evaluation::Judgement& found, const EvaluationInputs& inputs) {
  Section out{"annotations", "Manual annotations (Figures 7 and 8)"};
  out.paragraphs = {
      "Precision is low where annotators did not see what the sensors show: the paper has 0.65 for "
      "legs and 0.36 for hands at 45 degrees. Segments count as found when they share 0.3 of their "
      "union."};
  out.tables = {score_table(found, inputs)};
  out.plots = {bars_plot(found, inputs)};
  for (const auto group :
       {inertial::LimbGroup::Legs, inertial::LimbGroup::Arms, inertial::LimbGroup::Trunk}) {
    const bool any =
        std::ranges::any_of(found.limbs, [&](const auto& l) { return group_of(l.limb) == group; });
    if (any) out.plots.push_back(tau_plot(found, inputs, group));
  }
  return out;
}

Section refusals(const evaluation::Judgement& found) {
  Section out{"refused", "Sensors that could not be calibrated"};
  for (const Error& error : found.refused) out.paragraphs.push_back(to_string(error));
  return out;
}

std::string verdict_of(const evaluation::Judgement& found, const EvaluationInputs& inputs) {
  std::string bad;
  for (const JudgedLimb& limb : found.limbs)
    if (error_percent(limb) > inputs.most_percent)
      bad += (bad.empty() ? "" : ", ") + std::string(words_for(limb.limb));
  std::string out = bad.empty() ? "No limb is in error for longer than allowed."
                                : "In error for too long: " + bad + ".";
  if (inputs.reference) out += " " + reference_verdict(*inputs.reference);
  return out;
}

}  // namespace

double error_percent(const JudgedLimb& limb) {
  double inside_count = 0.0;
  for (const auto& each : limb.errors) inside_count += inside(limb.detected, each.time) ? 1.0 : 0.0;
  return limb.errors.empty() ? 0.0 : 100.0 * inside_count / static_cast<double>(limb.errors.size());
}

report::Report evaluation_report(const evaluation::Judgement& found,
                                 const EvaluationInputs& inputs) {
  report::Report out;
  out.kind = "evaluation";
  out.title = "A tracker judged with inertial sensors";
  out.subject = {
      {"tracking", inputs.tracking},
      {"sensors", fmt::format("{}", fmt::join(inputs.inertial, ", "))},
      {"tau", fmt::format("{:.0f} deg", to_deg(inputs.tau))},
      {"judged", fmt::format("{:.1f} s to {:.1f} s", found.begin, found.end)},
      {"clocks",
       fmt::format("sensors {:+.1f} +- {:.1f} ms behind the tracker, correlation {:.2f}",
                   1e3 * found.shift.shift, 1e3 * found.shift.sigma, found.shift.correlation)}};
  Section limbs{"limbs", "Limbs"};
  Section distances{"distances", "Distance of tracker and sensor (Figure 5)"};
  distances.paragraphs = {
      "d_quat of Baak et al., Eq. (13). Shaded: above tau, with hysteresis. Where a limb is "
      "straight its twist cannot be seen, and only the swing counts."};
  Section rates{"rates", "Angular rates (Figure 9)"};
  rates.paragraphs = {
      "The same take as angular rates of both worlds: errors that last hardly show."};
  for (const JudgedLimb& limb : found.limbs) {
    for (Figure& figure : figures_of(limb, inputs)) limbs.figures.push_back(std::move(figure));
    distances.plots.push_back(distance_plot(limb, inputs.tau));
    rates.plots.push_back(rate_plot(limb));
  }
  out.sections = {std::move(limbs)};
  if (inputs.reference) out.sections.push_back(reference_section(*inputs.reference, inputs.tau));
  out.sections.push_back(std::move(distances));
  if (!inputs.annotations.empty()) out.sections.push_back(annotation_section(found, inputs));
  out.sections.push_back(std::move(rates));
  if (!found.refused.empty()) out.sections.push_back(refusals(found));
  out.judgement = report::worst_of(out.sections);
  out.verdict = verdict_of(found, inputs);
  return out;
}

}  // namespace chorus::ctl
