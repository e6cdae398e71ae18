#include "fusion-server/core/adoption.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fusion-server/core/place_change.h"
#include "fusion-server/core/world.h"

namespace chorus::core {

const char* const kContradicted =
    "the sensors that have a place do not stand as the last walk showed them: if one was moved, "
    "register all anew (chorus register --fresh)";

namespace {

int rank(Verdict verdict) {
  switch (verdict) {
    case Verdict::Good:
      return 2;
    case Verdict::Provisional:
      return 1;
    case Verdict::None:
    case Verdict::Refused:
      return 0;
  }
  return 0;
}

bool usable(const Registration& registration) {
  return rank(registration.verdict) > 0 && !registration.sensors.empty();
}

bool covers(const Registration& wider, const Registration& narrower) {
  return std::all_of(narrower.sensors.begin(), narrower.sensors.end(),
                     [&](const auto& entry) { return wider.sensors.contains(entry.first); });
}

bool stands_well(const Registration& registration, const SensorId& sensor) {
  return verdict_of(registration, sensor) == Verdict::Good;
}

/// True if the candidate places any sensor worse than it stands, where it stands.
bool worsens(const Registration& current, const Registration& candidate) {
  const auto between = between_worlds(current, candidate, {});
  return std::ranges::any_of(current.sensors, [&](const auto& entry) {
    return candidate.sensors.contains(entry.first) &&
           change_of(current, candidate, entry.first, between) == Change::Worse;
  });
}

/// Whether extended() takes the place of a sensor that has one from the candidate.
bool is_improved(const Registration& current, const Registration& candidate, const SensorId& sensor,
                 SolveKind kind) {
  const int before = rank(verdict_of(current, sensor));
  const int after = rank(verdict_of(candidate, sensor));
  if (after != before) return after > before && stands_well(candidate, sensor);
  if (stands_well(current, sensor) || sensor == current.master) return false;
  const auto between = between_worlds(current, candidate, {sensor});
  const Change change = change_of(current, candidate, sensor, between);
  return change == Change::Better ||
         (between && kind == SolveKind::Final && change == Change::Elsewhere);
}

/// The sensors whose places extended() takes from the candidate: those that have none, and those
/// that it places better.
std::set<SensorId> newcomers(const Registration& current, const Registration& candidate,
                             SolveKind kind) {
  std::set<SensorId> found;
  for (const auto& [sensor, place] : candidate.sensors) {
    if (!current.sensors.contains(sensor) || is_improved(current, candidate, sensor, kind))
      found.insert(sensor);
  }
  return found;
}

/// Makes the place's chain and error start at our master instead of the candidate's.  The new chain
/// is that of the first sensor on the old chain that our registration places, continued by the rest
/// of the old chain.  A part of the error may count twice.
void lead_from_master(const Registration& current, Extrinsics& place) {
  if (place.chain.empty() || place.chain.front() == current.master) return;
  // The last sensor is the one to be placed; what we knew of it no longer holds.
  const auto end =
      std::next(place.chain.begin(), std::max<std::ptrdiff_t>(1, std::ssize(place.chain) - 1));
  const auto held = std::find_if(place.chain.begin(), end, [&](const SensorId& sensor) {
    return current.sensors.contains(sensor);
  });
  if (held == end) return;
  const auto known = current.sensors.find(*held);
  std::vector<SensorId> chain = known->second.chain;
  chain.insert(chain.end(), std::next(held), place.chain.end());
  place.chain = std::move(chain);
  place.next_chain.clear();  // it leads from the candidate's master
  place.error += known->second.error;
}

/// The sensor's clock offset to our common clock, as it holds for the capture times of the
/// candidate's walk (`walked`); none if it is not known.
std::optional<ClockOffset> our_clock(const Registration& current, const SensorId& sensor,
                                     const ClockOffset& walked) {
  const auto own = current.clocks.find(sensor);
  if (own != current.clocks.end() && holds_for(own->second, seconds(walked.stated))) {
    ClockOffset clock = own->second;
    if (!exchanges_time(seconds(clock.stated)) && clock.least_age && walked.least_age)
      clock.added += *walked.least_age - *clock.least_age;
    return clock;
  }
  if (!exchanges_time(seconds(walked.stated))) return std::nullopt;
  return ClockOffset{Duration{0}, walked.stated, walked.stated, walked.least_age};
}

/// What is added to the candidate's offsets to refer them to our common clock, taken from the held
/// sensor whose own clock offset is known best; zero if none is known.
ClockOffset between_clocks(const Registration& current, const Registration& candidate,
                           const std::set<SensorId>& added) {
  std::optional<ClockOffset> best;
  for (const auto& [sensor, walked] : candidate.clocks) {
    if (added.contains(sensor) || !current.sensors.contains(sensor)) continue;
    const auto ours = our_clock(current, sensor, walked);
    if (!ours) continue;
    const Duration sigma = from_seconds(std::hypot(seconds(ours->sigma), seconds(walked.sigma)));
    if (!best || sigma < best->sigma) best = ClockOffset{ours->added - walked.added, sigma};
  }
  return best.value_or(ClockOffset{});
}

/// Takes over the newcomers' clock offsets from the candidate's walk, referred to our common clock.
void take_clocks(Registration& wider, const Registration& candidate,
                 const std::set<SensorId>& added) {
  const ClockOffset ours_from_theirs = between_clocks(wider, candidate, added);
  for (const SensorId& sensor : added) {
    wider.clocks.erase(sensor);
    const auto found = candidate.clocks.find(sensor);
    if (found == candidate.clocks.end()) continue;
    ClockOffset clock = found->second;
    clock.added += ours_from_theirs.added;
    clock.sigma = from_seconds(std::hypot(seconds(clock.sigma), seconds(ours_from_theirs.sigma)));
    wider.clocks[sensor] = clock;
  }
}

/// Takes over the newcomers' latencies from the candidate's walk, relative to the held sensors as
/// these are corrected now.
void take_latencies(Registration& wider, const Registration& candidate,
                    const std::set<SensorId>& added) {
  const Latency* theirs = nullptr;
  Duration between{0};
  for (const auto& [sensor, walked] : candidate.latencies) {
    if (added.contains(sensor) || !wider.sensors.contains(sensor)) continue;
    if (theirs != nullptr && theirs->sigma <= walked.sigma) continue;
    theirs = &walked;
    const auto own = wider.latencies.find(sensor);
    const Duration ours = own == wider.latencies.end() ? Duration{0} : own->second.added();
    between = ours - walked.added();
  }
  for (const SensorId& sensor : added) {
    wider.latencies.erase(sensor);
    const auto found = candidate.latencies.find(sensor);
    if (found == candidate.latencies.end()) continue;
    Latency latency = found->second;
    latency.found -= between;
    latency.applied = latency.applied || between != Duration{0};
    wider.latencies[sensor] = latency;
  }
}

void add_once(std::vector<std::string>& reasons, const std::vector<std::string>& more) {
  for (const std::string& reason : more) {
    if (std::find(reasons.begin(), reasons.end(), reason) == reasons.end())
      reasons.push_back(reason);
  }
}

/// The registration's reasons that are not those of a single sensor.
std::vector<std::string> common_reasons(const Registration& registration) {
  std::vector<std::string> reasons = registration.reasons;
  for (const auto& [sensor, own] : registration.verdicts) {
    for (const std::string& reason : own.reasons) std::erase(reasons, reason);
  }
  return reasons;
}

/// Replaces the verdict on one sensor, and its reasons among those of the whole registration.
void take_verdict(Registration& registration, const SensorId& sensor, SensorVerdict verdict) {
  const auto shared = common_reasons(registration);
  registration.verdicts[sensor] = std::move(verdict);
  registration.reasons = shared;
  for (const auto& [other, own] : registration.verdicts)
    add_once(registration.reasons, own.reasons);
}

/// A sensor's verdict with its own reasons; if it is not Good, also with those that concern the
/// whole walk.
SensorVerdict sentence_of(const Registration& candidate, const SensorId& sensor) {
  SensorVerdict sentence{verdict_of(candidate, sensor), {}};
  const auto own = candidate.verdicts.find(sensor);
  if (own != candidate.verdicts.end()) sentence.reasons = own->second.reasons;
  if (sentence.verdict != Verdict::Good) add_once(sentence.reasons, common_reasons(candidate));
  return sentence;
}

Verdict least_of_placed(const Registration& registration) {
  Verdict least = Verdict::Good;
  for (const auto& [sensor, place] : registration.sensors) {
    const Verdict own = verdict_of(registration, sensor);
    if (rank(own) < rank(least)) least = own;
  }
  return least;
}

/// Gives each sensor without a verdict that of the whole registration.  Registrations from a file,
/// and those that older versions stored, have no verdict per sensor.
void spell_out_verdicts(Registration& registration) {
  for (const auto& [sensor, place] : registration.sensors)
    registration.verdicts.try_emplace(sensor, SensorVerdict{registration.verdict, {}});
}

}  // namespace

Verdict verdict_of(const Registration& registration, const SensorId& sensor) {
  if (!registration.sensors.contains(sensor)) return Verdict::None;
  const auto own = registration.verdicts.find(sensor);
  return own == registration.verdicts.end() ? registration.verdict : own->second.verdict;
}

bool should_replace(const Registration& current, const Registration& candidate, SolveKind kind) {
  if (!usable(candidate)) return false;
  if (!usable(current)) return true;
  if (!covers(candidate, current)) return false;
  if (rank(candidate.verdict) != rank(current.verdict))
    return rank(candidate.verdict) > rank(current.verdict);
  // A provisional solve during the walk does not replace a good registration; the final one may.
  // Neither does when it would place any sensor worse: then only the others get their new places.
  if (worsens(current, candidate)) return false;
  return kind == SolveKind::Final || current.verdict == Verdict::Provisional;
}

Result<Registration> extended(const Registration& current, const Registration& candidate,
                              SolveKind kind) {
  const std::set<SensorId> added = newcomers(current, candidate, kind);
  if (!usable(current) || !usable(candidate) || added.empty())
    return fail(ErrorCode::NotFound, "registration",
                "no sensor is better placed than before; walk longer, and where the sensors look "
                "together");
  const auto world_from_candidate = between_worlds(current, candidate, added);
  if (!world_from_candidate) return fail(ErrorCode::Conflict, "registration", kContradicted);
  Registration wider = current;
  std::erase(wider.reasons, kContradicted);
  wider.solved = candidate.solved;
  spell_out_verdicts(wider);
  for (const SensorId& sensor : added) {
    Extrinsics place = moved(candidate.sensors.at(sensor), *world_from_candidate);
    lead_from_master(current, place);
    wider.sensors.insert_or_assign(sensor, std::move(place));
    wider.anchors.erase(sensor);
    take_verdict(wider, sensor, sentence_of(candidate, sensor));
  }
  take_clocks(wider, candidate, added);
  take_latencies(wider, candidate, added);
  const auto touches = [&](const PairwiseRegistration& edge) {
    return added.contains(edge.source) || added.contains(edge.target);
  };
  std::erase_if(wider.edges, touches);
  std::copy_if(candidate.edges.begin(), candidate.edges.end(), std::back_inserter(wider.edges),
               touches);
  wider.verdict = least_of_placed(wider);
  return wider;
}

Result<Registration> adopted(const Registration& current, const Registration& candidate,
                             SolveKind kind, bool hold) {
  const bool any_good =
      usable(current) && std::any_of(current.sensors.begin(), current.sensors.end(),
                                     [&](const auto& e) { return stands_well(current, e.first); });
  const bool bound = hold && any_good;
  if (!bound && should_replace(current, candidate, kind))
    return in_world_of(anchors_of(current), candidate);
  return extended(current, candidate, kind);
}

Registration confirmed_part(Registration candidate) {
  std::vector<SensorId> unconfirmed;
  for (const auto& [sensor, own] : candidate.verdicts) {
    if (own.unconfirmed && candidate.sensors.contains(sensor)) unconfirmed.push_back(sensor);
  }
  for (const SensorId& sensor : unconfirmed)
    candidate = without(std::move(candidate), sensor,
                        "sensor " + sensor.str() +
                            " was placed by directions alone, and is used once somebody has "
                            "accepted its place (chorus register --accept)");
  return candidate;
}

void note_refusals(Registration& current, const Registration& candidate) {
  for (const auto& [sensor, own] : candidate.verdicts) {
    if (own.verdict == Verdict::Refused && !current.sensors.contains(sensor))
      take_verdict(current, sensor, own);
  }
}

void note_contradiction(Registration& current) { add_once(current.reasons, {kContradicted}); }

Registration without(Registration current, const SensorId& sensor, const std::string& reason) {
  spell_out_verdicts(current);
  current.sensors.erase(sensor);
  current.anchors.erase(sensor);
  current.clocks.erase(sensor);
  current.latencies.erase(sensor);
  std::erase_if(current.edges, [&](const PairwiseRegistration& edge) {
    return edge.source == sensor || edge.target == sensor;
  });
  take_verdict(current, sensor, {Verdict::Refused, {reason}});
  current.verdict = current.sensors.empty() ? Verdict::None : least_of_placed(current);
  const auto best = std::ranges::min_element(current.sensors, {},
                                             [](const auto& entry) { return entry.second.error; });
  if (current.master == sensor && best != current.sensors.end()) current.master = best->first;
  return current;
}

void keep_configured(Registration& registration, const std::set<SensorId>& sensors) {
  const auto gone = [&](const auto& entry) { return !sensors.contains(entry.first); };
  std::erase_if(registration.sensors, gone);
  std::erase_if(registration.anchors, gone);
  std::erase_if(registration.verdicts, gone);
  std::erase_if(registration.clocks, gone);
  std::erase_if(registration.latencies, gone);
  std::erase_if(registration.edges, [&](const PairwiseRegistration& edge) {
    return !sensors.contains(edge.source) || !sensors.contains(edge.target);
  });
  if (registration.sensors.empty() || registration.sensors.contains(registration.master)) return;
  registration.master = std::ranges::min_element(registration.sensors, {}, [](const auto& entry) {
                          return entry.second.error;
                        })->first;
}

std::set<SensorId> unplaced(const Registration& current, const std::set<SensorId>& seeing) {
  std::set<SensorId> missing;
  for (const SensorId& sensor : seeing) {
    if (!current.sensors.contains(sensor)) missing.insert(sensor);
  }
  return missing;
}

}  // namespace chorus::core
