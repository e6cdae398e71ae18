// What the figures of a recording show to be wrong.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/quality/quality_report.h"

namespace chorus::quality {
namespace {

using report::Judgement;

// Limits of the verdict.  The shares are what people who use a recording notice: a joint that is
// away in one instant of twenty is a gap in every second step.
constexpr double kMissing = 0.05;
constexpr double kMuchMissing = 0.25;
constexpr double kMoved =
    0.05;  // [m] the centre of a sensor's views changed between first and last third
constexpr double kOffset = 0.15;  // [m] a sensor's views stand beside the fused bodies all the time
constexpr double kClock = 0.03;   // [s]
constexpr double kSilence = 2.0;  // [s]
constexpr double kDisagrees = 2.5;  // times the median residual of the other sensors
constexpr double kRates = 0.6;      // of the median rate of the sensors
constexpr double kUnsure = 0.05;    // share of time with uncertain sides

using Findings = std::vector<Finding>;

double rounded_mm(double metres) { return std::round(1e3 * metres); }

double median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void of_joints(const RecordingQuality& quality, Findings& out) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const JointQuality& joint = quality.fused.joints[j];
    if (joint.missing <= kMissing) continue;
    out.push_back({joint.missing > kMuchMissing ? Judgement::Bad : Judgement::Doubtful,
                   fmt::format("{} is missing in {:.0f} %", kJointNames[j], 100.0 * joint.missing),
                   "add or turn a sensor so that one more sees it"});
  }
}

void of_moments(const RecordingQuality& quality, Findings& out) {
  const FusedQuality& fused = quality.fused;
  const auto say = [&](const std::vector<Moment>& moments, const std::string& what,
                       const std::string& advice) {
    if (moments.empty()) return;
    out.push_back({Judgement::Bad,
                   fmt::format("{}: {} times, first at {:.1f} s (person {})", what, moments.size(),
                               moments.front().at, moments.front().person),
                   advice});
  };
  say(fused.turned, "left and right were exchanged",
      "add a sensor that sees people from the front");
  say(fused.doubles, "one person was published twice",
      "register anew: a sensor's place or clock is wrong");
  say(fused.switches, "an id ended and another one began in its place",
      "treat both ids as one person");
}

void of_people(const RecordingQuality& quality, Findings& out) {
  for (const PersonQuality& person : quality.fused.people)
    if (person.uncertain_sides > kUnsure)
      out.push_back({Judgement::Doubtful,
                     fmt::format("left and right of person {} are uncertain in {:.0f} %", person.id,
                                 100.0 * person.uncertain_sides),
                     "walk a few steps forward, or add a sensor that sees people from the front"});
}

void of_sensor(const std::string& id, const SensorQuality& sensor, const RecordingQuality& quality,
               Findings& out) {
  const double change = (sensor.offset_last - sensor.offset_first).norm();
  const double offset = std::min(sensor.offset_first.norm(), sensor.offset_last.norm());
  if (change > kMoved)
    out.push_back({Judgement::Bad,
                   fmt::format("{} was moved: its views changed by {} mm against the fused bodies",
                               id, rounded_mm(change)),
                   "fix it and register anew"});
  else if (offset > kOffset)
    out.push_back(
        {Judgement::Bad,
         fmt::format("{} stands {} mm beside where it is registered", id, rounded_mm(offset)),
         "register anew"});
  if (std::abs(sensor.clock) > kClock)
    out.push_back({Judgement::Bad,
                   fmt::format("the clock of {} is off by {:.0f} ms", id, 1e3 * sensor.clock),
                   "synchronise its host (chrony), or fuse anew with the clocks searched"});
  if (sensor.longest_silence > kSilence)
    out.push_back({Judgement::Doubtful,
                   fmt::format("{} was silent for {:.1f} s", id, sensor.longest_silence),
                   "look at its log and its network"});
  std::vector<double> rates;
  std::vector<double> residuals;
  for (const auto& [other, figures] : quality.sensors) {
    rates.push_back(figures.rate);
    if (other.str() != id) residuals.push_back(figures.residual);
  }
  if (sensor.rate < kRates * median(rates))
    out.push_back({Judgement::Doubtful,
                   fmt::format("{} delivers {:.1f} frames/s, the others {:.1f}", id, sensor.rate,
                               median(rates)),
                   "look at the load of its host and its exposure time"});
  if (sensor.residual > kDisagrees * median(residuals) && change <= kMoved && offset <= kOffset)
    out.push_back({Judgement::Doubtful,
                   fmt::format("{} disagrees with the others: {} mm, they {} mm", id,
                               rounded_mm(sensor.residual), rounded_mm(median(residuals))),
                   "check its lens, its model and what it looks at"});
}

}  // namespace

Findings findings_of(const RecordingQuality& quality) {
  Findings out;
  if (quality.fused.frames == 0)
    return {{Judgement::Bad, "there are no fused frames",
             "fuse it first: chorus fuse REC --out FUSED"}};
  if (quality.fused.people.empty())
    out.push_back({Judgement::Bad, "nobody is in any frame", "look at the sensors' own views"});
  if (!quality.verdict.empty() && quality.verdict != "Good")
    out.push_back(
        {Judgement::Doubtful, "the registration is " + quality.verdict, "walk until it is Good"});
  if (quality.fused.pauses > 0)
    out.push_back({Judgement::Doubtful,
                   fmt::format("the output paused {} times, once for {:.1f} s",
                               quality.fused.pauses, quality.fused.longest_pause),
                   "look at the load of the fusion host"});
  of_moments(quality, out);
  for (const auto& [id, sensor] : quality.sensors) of_sensor(id.str(), sensor, quality, out);
  of_joints(quality, out);
  of_people(quality, out);
  std::stable_sort(out.begin(), out.end(),
                   [](const Finding& a, const Finding& b) { return a.judgement > b.judgement; });
  return out;
}

}  // namespace chorus::quality
