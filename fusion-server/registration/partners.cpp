#include "fusion-server/registration/partners.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace chorus::registration {
namespace {

constexpr std::size_t kAllPairs = 12;  // up to this many sensors, all pairs are tried
// With more than kAllPairs sensors, each one chooses this many partners.
constexpr std::size_t kPartners = 8;
// Two sensors that saw the person in the same bin count as having seen the person together.
constexpr auto kBin = std::chrono::seconds(1);

/// Number of frames in which the person had moved, by seconds since 1970.
using Presence = std::map<std::int64_t, std::size_t>;

Presence presence_of(const Trail& trail) {
  Presence presence;
  for (const TrailFrame& frame : trail.frames) {
    if (frame.moved) ++presence[frame.captured.time_since_epoch() / Duration(kBin)];
  }
  return presence;
}

/// Number of frames that both have, summed second by second.
std::size_t overlap(const Presence& a, const Presence& b) {
  std::size_t common = 0;
  for (auto first = a.begin(), second = b.begin(); first != a.end() && second != b.end();) {
    if (first->first < second->first) {
      ++first;
    } else if (second->first < first->first) {
      ++second;
    } else {
      common += std::min((first++)->second, (second++)->second);
    }
  }
  return common;
}

using Overlaps = std::vector<std::vector<std::size_t>>;

Overlaps overlaps_of(const std::map<SensorId, Walker>& walkers) {
  std::vector<Presence> presences;
  for (const auto& [sensor, walker] : walkers) presences.push_back(presence_of(walker.trail));
  Overlaps overlaps(presences.size(), std::vector<std::size_t>(presences.size(), 0));
  for (std::size_t i = 0; i < presences.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      overlaps[i][j] = overlaps[j][i] = overlap(presences[i], presences[j]);
  }
  return overlaps;
}

using Pairs = std::set<std::pair<std::size_t, std::size_t>>;

/// Adds the pairs of sensor i with the sensors that share most with it; of equal ones it takes
/// those that follow i, so that not all sensors choose the same partners.
void add_best(const Overlaps& overlaps, std::size_t i, Pairs& pairs) {
  const std::size_t count = overlaps.size();
  std::vector<std::size_t> others;
  for (std::size_t step = 1; step < count; ++step) others.push_back((i + step) % count);
  std::ranges::stable_sort(
      others, [&](std::size_t a, std::size_t b) { return overlaps[i][a] > overlaps[i][b]; });
  for (std::size_t k = 0; k < std::min(kPartners, others.size()); ++k)
    pairs.insert(std::minmax(i, others[k]));
}

/// For each of `count` sensors the number of its group: sensors that `links` connect have the same
/// number.
std::vector<std::size_t> groups_of(const Pairs& links, std::size_t count) {
  std::vector<std::size_t> group(count);
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (const auto& [a, b] : links) {
    const std::size_t from = group[a];
    const std::size_t to = group[b];
    std::ranges::replace(group, from, to);
  }
  return group;
}

/// The pairs of sensors of different groups.
Pairs between(const std::vector<std::size_t>& group) {
  Pairs pairs;
  for (std::size_t i = 0; i < group.size(); ++i) {
    for (std::size_t j = i + 1; j < group.size(); ++j) {
      if (group[i] != group[j]) pairs.insert({i, j});
    }
  }
  return pairs;
}

Pairs chosen_among(const Overlaps& overlaps) {
  Pairs pairs;
  Pairs links;  // those that saw the person together
  for (std::size_t i = 0; i < overlaps.size(); ++i) add_best(overlaps, i, pairs);
  for (const auto& [a, b] : pairs) {
    if (overlaps[a][b] > 0) links.insert({a, b});
  }
  pairs.merge(between(groups_of(links, overlaps.size())));
  for (std::size_t i = 0; i < overlaps.size(); ++i) {
    for (std::size_t j = i + 1; j < overlaps.size(); ++j) {
      if (overlaps[i][j] == 0) pairs.insert({i, j});  // trying it costs little: see partners_of()
    }
  }
  return pairs;
}

Pairs all_of(std::size_t count) { return between(groups_of({}, count)); }

std::vector<SensorId> names_of(const std::map<SensorId, Walker>& walkers) {
  std::vector<SensorId> names;
  for (const auto& [sensor, walker] : walkers) names.push_back(sensor);
  return names;
}

}  // namespace

std::vector<SensorPair> partners_of(const std::map<SensorId, Walker>& walkers) {
  const std::vector<SensorId> sensors = names_of(walkers);
  const bool few = sensors.size() <= kAllPairs;
  std::vector<SensorPair> partners;
  for (const auto& [a, b] : few ? all_of(sensors.size()) : chosen_among(overlaps_of(walkers)))
    partners.emplace_back(sensors[a], sensors[b]);
  return partners;
}

std::vector<SensorPair> untried_links(const std::map<SensorId, Walker>& walkers,
                                      const std::vector<SensorPair>& tried,
                                      const std::vector<PairwiseRegistration>& edges) {
  const std::vector<SensorId> sensors = names_of(walkers);
  const auto number = [&](const SensorId& sensor) {
    return static_cast<std::size_t>(std::ranges::lower_bound(sensors, sensor) - sensors.begin());
  };
  Pairs links;
  for (const PairwiseRegistration& edge : edges)
    links.insert(std::minmax(number(edge.target), number(edge.source)));
  const std::set<SensorPair> known(tried.begin(), tried.end());
  std::vector<SensorPair> untried;
  for (const auto& [a, b] : between(groups_of(links, sensors.size()))) {
    if (!known.contains({sensors[a], sensors[b]})) untried.emplace_back(sensors[a], sensors[b]);
  }
  return untried;
}

}  // namespace chorus::registration
