// What the figures of a recording show to be wrong.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/quality/quality_report.h"
#include "common/quality/sensor_findings.h"

namespace chorus::quality {
namespace {

using report::Judgement;

// Limits of the verdict.  The shares are what people who use a recording notice: a joint that is
// away in one instant of twenty is a gap in every second step.
constexpr double kMissing = 0.05;
constexpr double kMuchMissing = 0.25;
constexpr double kAlike = 0.03;        // joints whose shares differ by less are named together
constexpr double kUnsure = 0.05;       // share of time with uncertain sides
constexpr double kJumpsAMinute = 2.0;  // of one joint
/// Found error over stated error.  Of healthy recordings the first is found 0.8 to 1.2 times as
/// large as it is (docs/benchmarks/report.md).
constexpr double kUnderstated = 2.5;

constexpr double kDay = 86'400.0;         // [s]
constexpr double kOtherDay = 0.5 * kDay;  // no take lasts as long; a pause of the output is shorter

using Findings = std::vector<Finding>;

std::string whole_percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

/// Joints that are away alike: a hand is lost as a whole.
struct Away {
  double missing = 0.0;
  double unseen = 0.0;
  std::vector<std::string> joints;

  [[nodiscard]] double share() const { return missing + unseen; }
};

/// Not every model of a body has these; a joint that is never there is none that is lost.
bool never_there(const FusedQuality& fused, std::size_t joint) {
  constexpr std::array kEnds{JointId::HandLeft,     JointId::HandRight, JointId::HandTipLeft,
                             JointId::HandTipRight, JointId::ThumbLeft, JointId::ThumbRight,
                             JointId::FootLeft,     JointId::FootRight};
  return fused.joints[joint].missing >= 1.0 &&
         std::ranges::find(kEnds, static_cast<JointId>(joint)) != kEnds.end();
}

std::vector<Away> joints_away(const FusedQuality& fused) {
  std::vector<Away> out;
  const bool told = !fused.shares.empty();  // who contributes
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Away each{fused.joints[j].missing, told ? fused.joints[j].unseen : 0.0, {}};
    if (each.share() <= kMissing || never_there(fused, j)) continue;
    const auto alike = std::ranges::find_if(out, [&](const Away& other) {
      return std::abs(other.missing - each.missing) < kAlike &&
             std::abs(other.unseen - each.unseen) < kAlike;
    });
    Away& group = alike == out.end() ? out.emplace_back(each) : *alike;
    group.missing = std::max(group.missing, each.missing);
    group.unseen = std::max(group.unseen, each.unseen);
    group.joints.emplace_back(kJointNames[j]);
  }
  return out;
}

void of_joints(const RecordingQuality& quality, Findings& out) {
  for (const Away& away : joints_away(quality.fused)) {
    const char* verb = away.joints.size() > 1 ? "are" : "is";
    std::string how;
    if (away.missing > 0.005) how = "missing in " + whole_percent(away.missing);
    if (away.unseen > 0.005)
      how += (how.empty() ? "" : " and ") + ("guessed in " + whole_percent(away.unseen));
    out.push_back({away.share() > kMuchMissing ? Judgement::Bad : Judgement::Doubtful,
                   fmt::format("{} {} {}", fmt::join(away.joints, ", "), verb, how),
                   "add or turn a sensor so that one more sees it"});
  }
}

void of_jumps(const RecordingQuality& quality, Findings& out) {
  const FusedQuality& fused = quality.fused;
  std::size_t worst = 0;
  int all = 0;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    all += fused.joints[j].jumps;
    if (fused.joints[j].jumps > fused.joints[worst].jumps) worst = j;
  }
  const JointQuality& joint = fused.joints[worst];
  const double minutes = std::max(1.0, fused.seconds / 60.0);
  if (static_cast<double>(joint.jumps) <= kJumpsAMinute * minutes) return;
  out.push_back({Judgement::Doubtful,
                 fmt::format("{} jumps {} times, first at {:.1f} s ({} jumps of all joints)",
                             kJointNames[worst], joint.jumps, joint.first_jump_at, all),
                 "look at that moment: a sensor may see something else there"});
}

/// Found error over stated error of all joints together; NaN: the views do not tell.
double understated(const RecordingQuality& quality) {
  double found = 0.0;
  double stated = 0.0;
  for (const ViewError& each : quality.views) {
    if (!(each.found > 0.0) || !(each.stated > 0.0)) continue;
    found += each.found * each.found;
    stated += each.stated * each.stated;
  }
  return std::sqrt(found / stated);
}

void of_stated_errors(const RecordingQuality& quality, Findings& out) {
  const double ratio = understated(quality);
  if (!(ratio > kUnderstated)) return;
  out.push_back({Judgement::Doubtful,
                 fmt::format("errors are {:.1f} times as large as stated, by the views", ratio),
                 "do not rely on stated errors; register anew, or train the error model"});
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

}  // namespace

std::vector<std::string> remarks_of(const RecordingQuality& quality) {
  std::vector<std::string> out;
  std::string never;
  for (std::size_t j = 0; j < kJointCount; ++j)
    if (never_there(quality.fused, j))
      never += (never.empty() ? "" : ", ") + std::string(kJointNames[j]);
  if (!never.empty()) out.push_back("no sensor ever reports " + never);
  if (quality.sensors.empty()) {
    out.emplace_back("sensors' own frames are not in it: who disagrees is unknown");
    return out;
  }
  if (quality.sensors.size() == 1)
    out.emplace_back(
        "it has one sensor, which nobody contradicts: errors of its place, its clock and "
        "its depth do not show");
  else if (too_short_for_trends(quality))
    out.emplace_back(
        "it is too short to tell whether a sensor stands wrongly, was moved, or has a wrong clock: "
        "record 10 s of walking or more");
  const auto compared = [](const auto& each) { return each.second.compared > 0; };
  const auto directions = [](const auto& each) { return each.second.rays > 0.5; };
  if (quality.verdict.empty())
    out.emplace_back(
        "no registration was recorded: where sensors stand is unknown, and so is who "
        "disagrees");
  else if (std::ranges::all_of(quality.sensors, directions))
    out.emplace_back("its cameras see directions alone, which are not compared with the bodies");
  else if (std::ranges::none_of(quality.sensors, compared))
    out.emplace_back(
        "no sensor's frame belongs to a fused body: do the recordings share a time, and "
        "is the registration theirs?");
  return out;
}

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
  if (quality.fused.longest_pause > kOtherDay)
    out.push_back({Judgement::Bad,
                   fmt::format("its frames are of different times: {:.1f} days lie between",
                               quality.fused.longest_pause / kDay),
                   "name recordings of one take"});
  else if (quality.fused.pauses > 0)
    out.push_back({Judgement::Doubtful,
                   fmt::format("the output paused {} times, once for {:.1f} s",
                               quality.fused.pauses, quality.fused.longest_pause),
                   "look at the load of the fusion host"});
  of_moments(quality, out);
  for (Finding& finding : sensor_findings(quality)) out.push_back(std::move(finding));
  of_jumps(quality, out);
  of_joints(quality, out);
  of_stated_errors(quality, out);
  of_people(quality, out);
  std::stable_sort(out.begin(), out.end(),
                   [](const Finding& a, const Finding& b) { return a.judgement > b.judgement; });
  return out;
}

}  // namespace chorus::quality
