#include "services/ctl/position/position_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "common/base/units.h"

namespace chorus::ctl {
namespace {

using positioning::Placed;
using report::Figure;
using report::Judgement;
using report::Mark;
using report::Plot;

constexpr double kHiddenFor = 0.3;  // Without a camera for longer, somebody counts as hidden [s].

// Medians of misfit over right takes and over wrong ones are apart by this
// (docs/benchmarks/positioner.md, "bad input").
constexpr double kLargestUsualMisfit = 1.1;

double hidden_share(const positioning::TakeResult& result) {
  const auto hidden =
      std::count_if(result.placed.begin(), result.placed.end(),
                    [](const Placed& one) { return seconds(one.online.hidden) > kHiddenFor; });
  return static_cast<double>(hidden) / static_cast<double>(result.placed.size());
}

double sigma_of(const Placed& one) { return std::sqrt(one.smooth.covariance.trace()); }

double middle_sigma(const positioning::TakeResult& result) {
  std::vector<double> all;
  for (const Placed& one : result.placed) all.push_back(sigma_of(one));
  std::sort(all.begin(), all.end());
  return all[all.size() / 2];
}

double drift_of(const PositionReport& take) {
  return (take.walked.back() - take.result.placed.back().smooth.place).norm();
}

Judgement judged(double value, double good, double doubtful) {
  if (!(value <= doubtful)) return Judgement::Bad;
  return value <= good ? Judgement::Good : Judgement::Doubtful;
}

Figure drift_figure(const PositionReport& take) {
  return {"drift",
          "the suit's steps alone end elsewhere by",
          to_mm(drift_of(take)),
          "mm",
          {},
          "what the cameras have corrected",
          {},
          {},
          Judgement::NotJudged};
}

std::vector<Figure> place_figures(const PositionReport& take) {
  const double answered = 100.0 * static_cast<double>(take.result.placed.size()) /
                          static_cast<double>(take.result.instants);
  const double hidden = 100.0 * hidden_share(take.result);
  const double sigma = to_mm(middle_sigma(take.result));
  return {{"answered",
           "instants with a place",
           answered,
           "%",
           {},
           "from the first sight on",
           "at least 97 %",
           "the person must be in the picture at the beginning",
           judged(100.0 - answered, 3.0, 20.0)},
          {"hidden",
           "time without a camera's sight",
           hidden,
           "%",
           {},
           "the suit's steps alone tell these places",
           "at most 10 %",
           "add a camera, or walk where it sees",
           judged(hidden, 10.0, 50.0)},
          {"sigma",
           "stated error of a place",
           sigma,
           "mm",
           {},
           "standard deviation, median over time",
           "at most 100 mm",
           "a second camera quarters it",
           judged(sigma, 100.0, 300.0)},
          drift_figure(take)};
}

/// The person's height that makes all cameras' depths right.  Two cameras or more judge together.
std::optional<Figure> stature_figure(const PositionReport& take) {
  double weights = 0.0;
  double sum = 0.0;
  for (const auto& [error, sigma] : take.result.depth) {
    const double weight = 1.0 / std::max(1e-8, sigma * sigma);
    weights += weight;
    sum += weight * error;
  }
  if (!(weights > 0.0) || !(take.stature > 0.0)) return std::nullopt;
  const double error = sum / weights;
  const double sigma = 1.0 / std::sqrt(weights);
  return Figure{"stature",
                "height of the person, as the cameras see it",
                100.0 * take.stature / (1.0 + error),
                "cm",
                fmt::format("give or take {:.1f} cm; {:.1f} cm was used",
                            100.0 * take.stature * sigma, 100.0 * take.stature),
                "a wrong focal length shows in it, too",
                {},
                "measure it, and state --stature",
                judged(std::abs(error), std::max(0.02, 2.0 * sigma), 0.1)};
}

Figure clock_figure(const std::string& camera, const positioning::ClockFit& clock) {
  return {"clock." + camera,
          "clock of the suit against that of " + camera,
          1e3 * clock.offset,
          "ms",
          clock.found ? fmt::format("give or take {:.0f} ms", 1e3 * clock.sigma)
                      : std::string("not found: nothing moves enough; that of other cameras is "
                                    "used, or 0"),
          "added to the suit's time",
          {},
          "wave, or state --clock-offset",
          clock.found ? Judgement::Good : Judgement::Doubtful};
}

Figure heading_figure(const positioning::TakeResult& result) {
  return {"heading",
          "heading of the suit in the world",
          to_deg(result.heading),
          "deg",
          fmt::format("give or take {:.1f} deg", to_deg(result.heading_sigma)),
          "at the end; it drifts",
          {},
          {},
          Judgement::NotJudged};
}

std::vector<Figure> found_figures(const PositionReport& take) {
  std::vector<Figure> out;
  for (std::size_t i = 0; i < take.result.clocks.cameras.size(); ++i)
    out.push_back(clock_figure(take.cameras[i].sensor.str(), take.result.clocks.cameras[i]));
  out.push_back(heading_figure(take.result));
  if (const auto stature = stature_figure(take)) out.push_back(*stature);
  for (std::size_t i = 0; i < take.result.depth.size(); ++i) {
    const auto& [error, sigma] = take.result.depth[i];
    out.push_back({"depth." + take.cameras[i].sensor.str(),
                   "depths of " + take.cameras[i].sensor.str() + " too long by", 100.0 * error, "%",
                   fmt::format("give or take {:.1f} %", 100.0 * sigma),
                   "the person is smaller than stated, or the focal length larger", "within 3 %",
                   "state --stature", judged(std::abs(100.0 * error), 3.0, 6.0)});
  }
  out.push_back({"ambiguous",
                 "instants at which another place fitted as well",
                 100.0 * static_cast<double>(take.result.ambiguous) /
                     static_cast<double>(take.result.placed.size()),
                 "%",
                 {},
                 "of the outline alone",
                 {},
                 {},
                 Judgement::NotJudged});
  out.push_back({"strangers",
                 "pictures of somebody whose pose is not the suit's",
                 static_cast<double>(take.result.strangers),
                 "",
                 {},
                 "they were left out",
                 "at most 10 % of the pictures",
                 "is it the right take, and the right person?",
                 judged(static_cast<double>(take.result.strangers),
                        0.1 * static_cast<double>(take.result.pictures),
                        0.5 * static_cast<double>(take.result.pictures))});
  return out;
}

report::Series path_of(const std::string& name, Mark mark,
                       const std::vector<Eigen::Vector3d>& places) {
  report::Series out{name, mark};
  for (const Eigen::Vector3d& place : places) {
    out.x.push_back(place.x());
    out.y.push_back(place.z());
  }
  return out;
}

/// Two standard deviations of the place over the floor, as crosses along the axes of the error,
/// once in half a second.
report::Series bars_of(const PositionReport& take) {
  constexpr double kEvery = 0.5;                                // [s]
  constexpr double kSigmas = 2.0;                               // To each side.
  const double gap = std::numeric_limits<double>::quiet_NaN();  // Lifts the pen.
  report::Series out{"error, two standard deviations", Mark::Line};
  double last = -kEvery;
  for (const Placed& one : take.result.placed) {
    if (seconds(one.time) - last < kEvery) continue;
    last = seconds(one.time);
    Eigen::Matrix2d floor;
    floor << one.smooth.covariance(0, 0), one.smooth.covariance(0, 2), one.smooth.covariance(2, 0),
        one.smooth.covariance(2, 2);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(floor);
    const Eigen::Vector2d at(one.smooth.place.x(), one.smooth.place.z());
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d half = kSigmas * std::sqrt(std::max(0.0, axes.eigenvalues()[axis])) *
                                   axes.eigenvectors().col(axis);
      for (const Eigen::Vector2d& end : {Eigen::Vector2d(at - half), Eigen::Vector2d(at + half)}) {
        out.x.push_back(end.x());
        out.y.push_back(end.y());
      }
      out.x.push_back(gap);
      out.y.push_back(gap);
    }
  }
  return out;
}

Plot path_plot(const PositionReport& take) {
  std::vector<Eigen::Vector3d> online;
  std::vector<Eigen::Vector3d> smooth;
  for (const Placed& one : take.result.placed) {
    online.push_back(one.online.position.place);
    smooth.push_back(one.smooth.place);
  }
  std::vector<Eigen::Vector3d> cameras;
  for (const auto& camera : take.cameras) cameras.push_back(camera.world_from_sensor.translation());
  Plot plot;
  plot.title = "Path from above";
  plot.x.label = "x [m]";
  plot.y.label = "z [m]";
  plot.same_scale = true;
  plot.height = 520;
  plot.series = {path_of("suit alone", Mark::Dashes, take.walked),
                 path_of("online", Mark::Line, online), path_of("smoothed", Mark::Line, smooth),
                 bars_of(take), path_of("cameras", Mark::Points, cameras)};
  return plot;
}

Plot time_plot(const PositionReport& take) {
  Plot plot;
  plot.title = "Stated error, and height of the hips";
  plot.x.label = "time [s]";
  plot.y.label = "[m]";
  report::Series sigma{"standard deviation of the place", Mark::Line};
  report::Series height{"hips above the floor", Mark::Line};
  double hidden_from = 0.0;
  bool was_hidden = false;
  for (const Placed& one : take.result.placed) {
    const double at = seconds(one.time);
    sigma.x.push_back(at);
    sigma.y.push_back(sigma_of(one));
    height.x.push_back(at);
    height.y.push_back(one.smooth.place.y());
    const bool hidden = seconds(one.online.hidden) > kHiddenFor;
    if (hidden && !was_hidden) hidden_from = at;
    if (!hidden && was_hidden) plot.spans.push_back({hidden_from, at});
    was_hidden = hidden;
  }
  if (was_hidden) plot.spans.push_back({hidden_from, seconds(take.result.placed.back().time)});
  plot.series = {std::move(sigma), std::move(height)};
  return plot;
}

/// One sentence for each thing that this take cannot show, or shows badly.
std::vector<std::string> distrusted_in(const PositionReport& take) {
  std::vector<std::string> out;
  if (take.cameras.size() == 1)
    out.emplace_back(
        "The distance from the camera: with a single camera it is about five times as uncertain as "
        "the direction.");
  out.emplace_back(
      "The camera's place: when it is wrong, everything is moved alike, which cannot be seen "
      "here.");
  for (std::size_t i = 0; i < take.result.clocks.cameras.size(); ++i) {
    const positioning::ClockFit& clock = take.result.clocks.cameras[i];
    if (clock.found) continue;
    out.push_back(fmt::format(
        "The clock of {}: no offset was found or stated, and {:.0f} ms was used; limbs then lag "
        "behind the place by as much as the clocks differ.",
        take.cameras[i].sensor.str(), 1e3 * clock.offset));
  }
  if (take.method == "suit")
    out.emplace_back("Everything but the first metres: steps add up, and what slides is not seen.");
  if (take.method == "silhouettes")
    out.emplace_back(
        "The stated error: the method states none, and a search that has lost the person does not "
        "notice it. Compare with --method both.");
  if (hidden_share(take.result) > 0.0)
    out.emplace_back(
        "The shaded times: nobody was seen, and the place is that of the suit's steps.");
  if (static_cast<double>(take.result.ambiguous) >
      0.1 * static_cast<double>(take.result.placed.size()))
    out.emplace_back(
        "The outline: in more than a tenth of the pictures another place fitted as well.");
  const std::vector<std::string> doubts = doubts_of(take.result);
  out.insert(out.end(), doubts.begin(), doubts.end());
  out.insert(out.end(), take.notes.begin(), take.notes.end());
  return out;
}

}  // namespace

report::Report position_report(const PositionReport& take) {
  report::Report out;
  out.kind = "position";
  out.title = "Place of a suit before cameras";
  out.subject = take.subject;
  out.subject.emplace_back("method", take.method);
  report::Section places{"places", "Places"};
  places.figures = place_figures(take);
  places.plots = {path_plot(take), time_plot(take)};
  places.paragraphs = {"Shaded: no camera saw the person; the place is that of the suit's steps."};
  report::Section found{"found", "Found with it"};
  found.figures = found_figures(take);
  report::Section distrust{"distrust", "What to distrust"};
  distrust.paragraphs = distrusted_in(take);
  out.sections = {std::move(places), std::move(found), std::move(distrust)};
  out.judgement = worst_of(out.sections);
  out.verdict = fmt::format("{} of {} instants have a place, with a stated error of {:.0f} mm.",
                            take.result.placed.size(), take.result.instants,
                            to_mm(middle_sigma(take.result)));
  return out;
}

std::vector<std::string> doubts_of(const positioning::TakeResult& result) {
  std::vector<std::string> out;
  if (std::ranges::any_of(result.clocks.cameras, [](const positioning::ClockFit& clock) {
        return clock.found && clock.at_edge;
      }))
    out.emplace_back(
        "the suit's clock is off by as much as was tried, or by more (--search); or its rate is "
        "wrong");
  if (result.without_suit > 0)
    out.push_back(
        fmt::format("the suit's take has no pose for {} of {} instants, which were left out",
                    result.without_suit, result.instants));
  if (result.misfit > kLargestUsualMisfit)
    out.push_back(
        fmt::format("the suit's pose fits what the cameras see badly ({:.1f} standard deviations; "
                    "usual are less than {:.1f}): is it this person's, of this take?",
                    result.misfit, kLargestUsualMisfit));
  return out;
}

namespace {

std::string clock_text(const std::string& camera, const positioning::ClockFit& clock) {
  if (clock.found)
    return fmt::format("clock of the suit against {}: {:+.0f} ms, give or take {:.0f}\n", camera,
                       1e3 * clock.offset, 1e3 * clock.sigma);
  return fmt::format(
      "clock of the suit against {}: not found, {:+.0f} ms is used; is there a wave, or a step, "
      "that both show?\n",
      camera, 1e3 * clock.offset);
}

}  // namespace

std::string position_text(const PositionReport& take) {
  std::string out = fmt::format(
      "{} of {} instants placed, give or take {:.0f} mm (median); {:.0f} % without a camera\n",
      take.result.placed.size(), take.result.instants, to_mm(middle_sigma(take.result)),
      100.0 * hidden_share(take.result));
  for (std::size_t i = 0; i < take.result.clocks.cameras.size(); ++i)
    out += clock_text(take.cameras[i].sensor.str(), take.result.clocks.cameras[i]);
  if (take.result.misfit > 0.0)
    out += fmt::format("landmarks fit the suit's pose to {:.2f} standard deviations (median)\n",
                       take.result.misfit);
  for (const std::string& doubt : doubts_of(take.result)) out += "doubt: " + doubt + '\n';
  out += fmt::format("heading of the suit: {:.1f} deg; the suit's steps alone end {:.0f} mm away\n",
                     to_deg(take.result.heading), to_mm(drift_of(take)));
  return out;
}

}  // namespace chorus::ctl
