#include "fusion-server/core/contests.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace chorus::core {
namespace {

// A sensor may lose a person for less than this, and nobody needs to know.
constexpr Duration kLasting = std::chrono::milliseconds(500);
// Glimpses farther apart than this do not last together.
constexpr Duration kLongestPause = std::chrono::milliseconds(250);
// A contest is told of for so long after its last instant, or it would flicker.
constexpr Duration kKept = std::chrono::seconds(3);

std::string names_of(const std::vector<SensorId>& sensors) {
  std::vector<std::string> names;
  for (const SensorId& sensor : sensors) names.push_back(sensor.str());
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string sentence_about(const Standing& standing) {
  const bool several = standing.seen_by.size() > 1;
  std::string text = fmt::format("{} {} somebody at ({:.1f}, {:.1f}) m", names_of(standing.seen_by),
                                 several ? "see" : "sees", standing.place.x(), standing.place.z());
  if (standing.image) return text + ", who is the image of another one in a mirror";
  if (!standing.on_floor) {
    return text + fmt::format(", whose middle is {:.1f} m {} the floor",
                              std::abs(standing.place.y()),
                              standing.place.y() < 0.0 ? "under" : "above");
  }
  return text + fmt::format(", where {} {} and {} nobody", names_of(standing.missed_by),
                            standing.missed_by.size() > 1 ? "look" : "looks",
                            standing.missed_by.size() > 1 ? "see" : "sees");
}

}  // namespace

void Contests::look(Timestamp instant, const std::vector<Standing>& standings) {
  for (const Standing& standing : standings) {
    const bool explained = standing.image || !standing.on_floor || !standing.missed_by.empty();
    if (standing.admitted || !explained) continue;
    Contest& contest =
        contests_.try_emplace(standing.id, Contest{instant, instant, {}}).first->second;
    if (!lasts(contest) && instant - contest.last > kLongestPause) contest.since = instant;
    contest.last = instant;
    contest.standing = standing;
    if (contest.counted || !lasts(contest)) continue;
    contest.counted = true;
    for (const SensorId& sensor : standing.seen_by) ++counts_[sensor];
  }
  std::erase_if(contests_, [&](const auto& entry) {
    return instant < entry.second.last || instant - entry.second.last > kKept;
  });
}

bool Contests::lasts(const Contest& contest) { return contest.last - contest.since >= kLasting; }

std::uint64_t Contests::count_of(const SensorId& sensor) const {
  const auto at = counts_.find(sensor);
  return at == counts_.end() ? 0 : at->second;
}

std::string Contests::sentence_of(const SensorId& sensor) const {
  for (const auto& [person, contest] : contests_) {
    const auto& seen_by = contest.standing.seen_by;
    if (!lasts(contest)) continue;
    if (std::ranges::find(seen_by, sensor) != seen_by.end())
      return sentence_about(contest.standing);
  }
  return {};
}

}  // namespace chorus::core
