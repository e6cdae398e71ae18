// The last step of solve_with(): which places are good, and why others are not.
#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/geometry/error_radius.h"
#include "fusion-server/registration/solve_work.h"
#include "fusion-server/registration/transform_graph.h"

namespace chorus::registration {

/// Refuses sensors whose place is too uncertain.
void refuse_wide(Work& work) {
  const std::map<SensorId, Extrinsics> all = work.result.sensors;
  for (const auto& [sensor, place] : all) {
    const double radius = radius_on_floor(place.covariance);
    if (radius <= work.config.max_position || place.chain.size() < 2) continue;
    const SensorId& neighbour = place.chain[place.chain.size() - 2];
    work.doubt(sensor,
               fmt::format("sensor {} would be placed only to within {:.2f} m, of {:.2f} m "
                           "allowed: walk where {} and {} both see you, and further to and fro",
                           sensor.str(), radius, work.config.max_position,
                           std::min(neighbour, sensor).str(), std::max(neighbour, sensor).str()));
    work.result.sensors.erase(sensor);
  }
}

namespace {

bool linked(const Work& work, const SensorId& sensor) {
  return work.result.sensors.contains(sensor);
}

/// Notes why this sensor is left out: why its pairs with linked sensors were refused.
void explain_unlinked(Work& work, const SensorId& sensor) {
  if (!work.result.verdicts[sensor].reasons.empty()) return;
  std::vector<std::string> strangers;
  std::vector<std::string> reasons;
  for (const Refusal& refusal : work.refusals) {
    if (refusal.target != sensor && refusal.source != sensor) continue;
    const SensorId& other = refusal.target == sensor ? refusal.source : refusal.target;
    if (!linked(work, other)) continue;
    if (refusal.error.code == ErrorCode::NotFound) {
      strangers.push_back(other.str());
    } else {
      reasons.push_back(refusal.error.message);
    }
  }
  if (work.walkers.at(sensor).trail.frames.empty()) {
    reasons = {why_empty(work.walkers.at(sensor).trail)};
  } else if (strangers.size() == 1 && reasons.empty()) {
    const auto [first, second] = std::minmax(sensor.str(), strangers.front());
    reasons = {fmt::format("sensors {} and {} never saw the person together", first, second)};
  } else if (reasons.empty() && strangers.empty()) {
    reasons = {fmt::format("sensor {}'s pairs are all with sensors without a place", sensor.str())};
  } else if (reasons.empty()) {
    reasons = {fmt::format("sensor {} never saw the person together with any of {}", sensor.str(),
                           fmt::join(strangers, ", "))};
  }
  for (std::string& reason : reasons) work.doubt(sensor, std::move(reason));
}

void explain_floor(Work& work, const SensorId& sensor) {
  const WalkFloor& floor = work.walkers.at(sensor).floor;
  if (!work.config.use_floor || floor.floor || work.config.cameras_alone) return;
  work.doubt(sensor,
             fmt::format("sensor {}: {}, so its pitch, roll and height come from the walk alone",
                         sensor.str(), floor.objection));
}

/// Length of the walk as seen by the sensor that watched it longest.
Duration duration_of(const Work& work) {
  Duration longest{};
  for (const auto& [sensor, walker] : work.walkers) {
    const auto& frames = walker.trail.frames;
    if (!frames.empty()) {
      longest = std::max(longest, frames.back().captured - frames.front().captured);
    }
  }
  return longest;
}

/// Adds a doubt if the chain of a sensor contains pairs that do not agree well.
void judge_chain(Work& work, const SensorId& sensor, const std::vector<SensorId>& chain) {
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const PairwiseRegistration* edge = edge_between(work.result.edges, chain[i - 1], chain[i]);
    if (edge == nullptr || edge->rms <= work.config.good_rms) continue;
    work.doubt(
        sensor,
        fmt::format(
            "sensors {} and {} differ by {:.3f} m rms along the walk; {:.3f} m would be good",
            edge->target.str(), edge->source.str(), edge->rms, work.config.good_rms));
  }
}

/// Places of cameras alone are judged once their scale is known (common_scale.h).
void judge_places(Work& work) {
  if (work.config.cameras_alone) return;
  for (const auto& [sensor, place] : work.result.sensors) judge_chain(work, sensor, place.chain);
  for (const auto& [sensor, place] : work.result.sensors) {
    const double radius = radius_on_floor(place.covariance);
    if (radius <= work.config.good_position) continue;
    work.doubt(
        sensor,
        fmt::format("sensor {} is placed only to within {:.3f} m; walk longer or further out",
                    sensor.str(), radius));
  }
}

void judge_accuracy(Work& work) {
  judge_places(work);
  // The time from the first frame to the last is always slightly less than requested.
  const Duration walked = std::chrono::round<std::chrono::seconds>(duration_of(work));
  if (walked < work.config.good_duration) {
    work.doubt(fmt::format("the walk lasted only {:.0f} s; {:.0f} s make a good registration",
                           seconds(walked), seconds(work.config.good_duration)));
  }
}

/// What few sensors agree on is no good registration of all.
void judge_majority(Work& work) {
  const std::size_t placed = work.result.sensors.size();
  if (2 * placed <= work.walkers.size())
    work.doubt(fmt::format("only {} of {} sensors have a place", placed, work.walkers.size()));
}

/// Sets the verdict of each sensor by the doubts about it, and that of all placed ones together.
void pass_sentence(Work& work) {
  work.result.verdict = work.doubtful ? Verdict::Provisional : Verdict::Good;
  for (const auto& [sensor, walker] : work.walkers) {
    SensorVerdict& own = work.result.verdicts[sensor];
    const bool doubtful = work.doubtful || !own.reasons.empty();
    own.verdict = doubtful ? Verdict::Provisional : Verdict::Good;
    if (!linked(work, sensor)) {
      own.verdict = Verdict::Refused;
    } else if (doubtful) {
      work.result.verdict = Verdict::Provisional;
    }
  }
}

}  // namespace

void judge(Work& work) {
  const std::size_t sensors = work.walkers.size();
  for (const auto& [sensor, walker] : work.walkers) {
    if (linked(work, sensor)) {
      explain_floor(work, sensor);
    } else {
      explain_unlinked(work, sensor);
    }
  }
  const bool nothing_linked = sensors > 1 && work.result.sensors.size() < 2;
  if (nothing_linked) {
    for (const auto& [sensor, walker] : work.walkers)
      work.result.verdicts[sensor].verdict = Verdict::Refused;
    work.result.verdict = Verdict::Refused;
    return;
  }
  if (sensors > 1) judge_majority(work);
  if (sensors > 1) judge_accuracy(work);
  pass_sentence(work);
}

}  // namespace chorus::registration
