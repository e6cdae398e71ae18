#include "fusion-server/core/awaited.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "fusion-server/core/coverage.h"

namespace chorus::core {

const char* const kDecide =
    "new places wait for your decision: chorus register --accept puts them into use, "
    "chorus register --decline keeps the old ones";

namespace {

/// "sensor s1" or "sensors s1, s2 and s3".
std::string named(const std::vector<SensorId>& sensors) {
  std::string text = sensors.size() == 1 ? "sensor " : "sensors ";
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (i > 0) text += i + 1 == sensors.size() ? " and " : ", ";
    text += sensors[i].str();
  }
  return text;
}

template <class Wanted>
std::vector<SensorId> those(const Situation& s, Wanted wanted) {
  std::vector<SensorId> found;
  std::copy_if(s.sensors.begin(), s.sensors.end(), std::back_inserter(found), wanted);
  return found;
}

/// Reports the silent sensors; true when no sensor delivers, so that nothing else matters.
bool say_silent(const Situation& s, std::vector<std::string>& out) {
  const auto silent =
      those(s, [&](const SensorId& sensor) { return !s.last_seen.delivers(sensor, s.now); });
  if (s.sensors.empty()) {
    out.emplace_back("no sensors are configured: add them under \"sensors\" in the configuration");
  } else if (silent.size() == s.sensors.size()) {
    out.emplace_back(
        "none of the sensors delivers frames: see /sensors/ for the reasons (not started, a wrong "
        "token, ...)");
  } else if (!silent.empty()) {
    out.push_back(named(silent) + (silent.size() == 1 ? " delivers" : " deliver") +
                  " no frames: see /sensors/ for the reason");
  }
  return silent.size() == s.sensors.size();
}

enum class Walker { TooFew, Crowd, Alone };

/// Reports a camera without depth that stands alone: no walk places it.
bool say_lone_camera(const Situation& s, std::vector<std::string>& out) {
  if (s.sensors.size() != 1) return false;
  const SensorId& only = *s.sensors.begin();
  if (!s.last_seen.sends_rays_alone(only) || s.registration.sensors.contains(only)) return false;
  out.push_back(fmt::format(
      "sensor {} sends directions without depth, which one camera alone cannot place: add a second "
      "one, or switch device.camera.depth_from_size on there",
      only.str()));
  return true;
}

/// Reports what is missing for a walk: too few sensors see somebody, or all of them several people.
Walker say_walker(const Situation& s, std::vector<std::string>& out) {
  const auto seeing =
      those(s, [&](const SensorId& sensor) { return s.last_seen.bodies(sensor, s.now) > 0; });
  const auto crowded =
      those(s, [&](const SensorId& sensor) { return s.last_seen.bodies(sensor, s.now) > 1; });
  const std::size_t enough = std::min<std::size_t>(2, s.sensors.size());
  if (seeing.empty()) {
    out.emplace_back(
        "nobody is in sight: let one person walk through the room, where sensors see them "
        "together");
  } else if (seeing.size() < enough) {
    out.push_back("only " + named(seeing) +
                  " sees somebody: walk where at least two sensors see you together");
  }
  if (!crowded.empty()) {
    out.push_back(named(crowded) + (crowded.size() == 1 ? " sees" : " see") +
                  " more than one body: one person alone should walk");
  }
  if (!seeing.empty() && crowded.size() == seeing.size()) return Walker::Crowd;
  return seeing.size() >= enough ? Walker::Alone : Walker::TooFew;
}

/// Reports which pairs need more of the walk, once it has lasted for a while.
void say_uncovered(const Situation& s, std::vector<std::string>& out) {
  constexpr double kAWhile = 6.0;  // [s]
  // At most this many sentences at once; the others follow when these needs are met.
  constexpr std::size_t kAtOnce = 2;
  if (s.session->elapsed < kAWhile) return;
  std::set<SensorId> seeing = s.last_seen.seeing(s.now);
  for (const PairCoverage& pair : s.session->pairs) seeing.insert({pair.first, pair.second});
  auto more = needs(s.session->pairs, seeing, s.wanted);
  more.resize(std::min(more.size(), kAtOnce));
  std::ranges::move(more, std::back_inserter(out));
}

/// Warns of a walk that cannot come into use, because a sensor that has a place is not there.  The
/// places of sensors that have none yet would be added all the same.
void say_in_vain(const Situation& s, std::vector<std::string>& out) {
  const auto placed = [&](const SensorId& sensor) {
    return s.registration.sensors.contains(sensor);
  };
  const auto gone = those(s, [&](const SensorId& sensor) {
    return placed(sensor) && !s.last_seen.delivers(sensor, s.now);
  });
  const auto added = those(s, [&](const SensorId& sensor) {
    return !placed(sensor) && s.last_seen.delivers(sensor, s.now);
  });
  if (gone.empty() || !added.empty()) return;
  out.push_back(fmt::format(
      "this walk will be in vain: the registration in use places {}, which {} nothing; start {}, "
      "or take {} out of \"sensors\" and reload",
      named(gone), gone.size() == 1 ? "delivers" : "deliver", gone.size() == 1 ? "it" : "them",
      gone.size() == 1 ? "it" : "them"));
}

void say_session(const Situation& s, Walker walker, std::vector<std::string>& out) {
  if (s.session->state == SessionState::Solving) {
    out.emplace_back("the walk is over: its places are being solved");
    return;
  }
  if (walker == Walker::Alone) {
    out.push_back(fmt::format("keep walking: {:.0f} s more",
                              std::ceil(std::max(0.0, s.session->target - s.session->elapsed))));
  }
  // While several people are in view, the walk shows nothing, wherever they go.
  if (walker != Walker::Crowd) say_uncovered(s, out);
  say_in_vain(s, out);
}

void say_start(const Situation& s, Walker walker, std::vector<std::string>& out) {
  if (s.proposes) return;  // no session starts by itself
  if (!s.automatic) {
    out.emplace_back(
        "sessions do not start by themselves: run chorus register (POST /registration)");
  } else if (s.retry) {
    out.push_back(
        fmt::format("the next try by itself is in {:.0f} s; chorus register tries at once",
                    std::ceil(seconds(*s.retry))));
  } else if (walker == Walker::Alone) {
    out.emplace_back("a session starts by itself");
  }
}

/// All have a place, but not a good one: says which walk would mend that.  None makes places of
/// directions alone good.
void say_provisional(const Situation& s, std::vector<std::string>& out) {
  if (s.registration.verdict != Verdict::Provisional || s.proposes) return;
  const auto rays = those(s, [&](const SensorId& id) { return s.last_seen.sends_rays_alone(id); });
  if (rays.size() >= s.registration.sensors.size()) return;
  std::vector<SensorId> weak;
  for (const auto& [sensor, place] : s.registration.sensors) {
    if (s.last_seen.sends_rays_alone(sensor)) continue;
    const auto own = s.registration.verdicts.find(sensor);
    if (own != s.registration.verdicts.end() && own->second.verdict != Verdict::Good &&
        sensor != s.registration.master)
      weak.push_back(sensor);
  }
  const std::string who = weak.empty() || weak.size() + 1 >= s.registration.sensors.size()
                              ? "the sensors stand"
                              : named(weak) + (weak.size() == 1 ? " stands" : " stand");
  const std::string why =
      s.registration.reasons.empty() ? std::string() : " (" + s.registration.reasons.front() + ")";
  out.push_back(who + " only provisionally" + why +
                ": chorus register, and walk for 30 s where the sensors see you together");
}

/// Says that all places are those of another setup.
void say_unpolled(const Situation& s, std::vector<std::string>& out) {
  std::vector<SensorId> placed;
  for (const auto& [sensor, place] : s.registration.sensors) {
    if (s.sensors.contains(sensor)) return;
    placed.push_back(sensor);
  }
  if (placed.empty() || s.sensors.empty()) return;
  out.push_back("the stored places are of another setup: " + named(placed) +
                (placed.size() == 1 ? " is" : " are") +
                " not configured; chorus register --fresh begins anew");
}

}  // namespace

std::vector<std::string> awaited(const Situation& s) {
  std::vector<std::string> out;
  if (s.proposes) out.emplace_back(kDecide);
  say_unpolled(s, out);
  const auto missing =
      those(s, [&](const SensorId& sensor) { return !s.registration.sensors.contains(sensor); });
  if (missing.empty() && s.session == nullptr && !s.sensors.empty()) {
    say_provisional(s, out);
    return out;
  }
  if (!missing.empty() && !s.registration.sensors.empty()) {
    out.push_back(named(missing) + (missing.size() == 1 ? " has" : " have") + " no place yet");
  }
  if (say_silent(s, out) || say_lone_camera(s, out)) return out;
  const Walker walker = say_walker(s, out);
  if (s.session != nullptr) {
    say_session(s, walker, out);
  } else {
    say_start(s, walker, out);
  }
  return out;
}

}  // namespace chorus::core
