#include "fusion-server/site/last_seen.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <Eigen/LU>

namespace chorus::site {
namespace {

// People out of sight: their speed decays with this time constant [s], as in associate, ...
constexpr double kSlowDown = 2.0;
// ... they speed up, slow down and turn: spectral density of the acceleration [m^2/s^3]; a walker
// who turns by 90 degrees within two seconds is 1.1 m off, ...
constexpr double kTurning = 0.5;
// ... and whatever they do, they move no faster than this on average [m/s], one sigma.
constexpr double kWandering = 1.0;
constexpr double kFastestWalk = 2.5;  // [m/s]
constexpr double kReach = 1.0;        // [m] that is allowed beyond that
// Cells' places and the place where a person is first seen, together [m].
constexpr double kRough = 0.2;
// One person in this area [m^2] would appear whom no cell has seen.  In a hall most who appear
// amid it were seen by another cell.
constexpr double kNewcomersArea = 100.0;
// After this time [s] a person out of sight has left the site with probability 1 - 1/e.
constexpr double kStays = 30.0;
// Lengths that differ prove much, but they may be of a bad view; lengths that agree prove less.
constexpr double kMostAgainst = 8.0;
constexpr double kMostFor = 5.0;
// Longest time by which a newcomer may have been seen before the last sight elsewhere [s].
constexpr double kOverlap = 1.0;

/// The missing people who are in one of the pairs, in their order; of more than can be matched
/// those with the largest ratio.
std::vector<std::size_t> likeliest_columns(const std::vector<PossiblePair>& pairs) {
  std::map<std::size_t, double> best;
  for (const PossiblePair& pair : pairs) {
    const auto [at, fresh] = best.try_emplace(pair.theirs, pair.rest);
    if (!fresh) at->second = std::max(at->second, pair.rest);
  }
  std::vector<std::pair<double, std::size_t>> all;
  for (const auto& [column, rest] : best) all.emplace_back(rest, column);
  std::ranges::sort(all, std::greater{});
  if (all.size() > kMatchColumns) all.resize(kMatchColumns);
  std::vector<std::size_t> columns;
  for (const auto& [rest, column] : all) columns.push_back(column);
  std::ranges::sort(columns);
  return columns;
}

/// The match of some columns as one of all of them; the others are matched with nobody.
JointMatch spread(const JointMatch& match, const std::vector<std::size_t>& columns,
                  std::size_t all) {
  JointMatch out{all, std::vector<double>(match.none.size() * all, 0.0), match.none};
  for (std::size_t i = 0; i < match.none.size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j)
      out.pairs[i * all + columns[j]] = match.at(i, j);
  }
  return out;
}

}  // namespace

void remember(LastSights& sights, const SiteId& id, const LastSight& sight) {
  if (sights.size() >= kMostSights && !sights.contains(id)) return;
  const auto [at, fresh] = sights.try_emplace(id, sight);
  if (!fresh && at->second.at < sight.at) at->second = sight;
}

Gone listed(const LastSights& sights) {
  Gone gone;
  for (const auto& [id, sight] : sights) {
    gone.ids.push_back(id);
    gone.sights.push_back(sight);
  }
  return gone;
}

void forget_before(LastSights& sights, Timestamp oldest) {
  std::erase_if(sights, [&](const auto& each) { return each.second.at < oldest; });
}

std::optional<double> return_odds(const LastSight& missing, const Newcomer& newcomer,
                                  const associate::Repeatability& repeatability) {
  const double elapsed = seconds(newcomer.at - missing.at);
  if (elapsed < -kOverlap) return std::nullopt;
  const double unseen = std::max(0.0, elapsed);
  const Eigen::Vector3d expected =
      missing.place + kSlowDown * (1.0 - std::exp(-elapsed / kSlowDown)) * missing.velocity;
  const Eigen::Vector3d off = newcomer.place - expected;
  const Eigen::Vector2d on_floor(off.x(), off.z());
  if (std::hypot(newcomer.place.x() - missing.place.x(), newcomer.place.z() - missing.place.z()) >
      kReach + kFastestWalk * unseen)
    return std::nullopt;
  const double turned = std::min(kTurning * unseen * unseen * unseen / 3.0,
                                 kWandering * kWandering * unseen * unseen);
  const double stated = 0.5 * (missing.covariance(0, 0) + missing.covariance(2, 2));
  const double variance = kRough * kRough + turned + std::min(1.0, stated);
  const double density =
      -0.5 * on_floor.squaredNorm() / variance - std::log(2.0 * std::numbers::pi * variance);
  const double lengths = associate::likeness(missing.lengths, newcomer.lengths, repeatability);
  return density + std::log(kNewcomersArea) - unseen / kStays +
         std::clamp(lengths, -kMostAgainst, kMostFor);
}

JointMatch match_returning(std::span<const Newcomer> newcomers, std::span<const LastSight> missing,
                           const associate::Repeatability& repeatability) {
  std::vector<PossiblePair> pairs;
  // There is no common error: each pair's ratio is known beforehand.
  CommonError exact;
  CommonTerm term;
  term.noise = Eigen::Matrix2d::Identity();
  const double own = log_density(exact, term);
  for (std::size_t i = 0; i < newcomers.size(); ++i) {
    for (std::size_t j = 0; j < missing.size(); ++j) {
      if (const auto odds = return_odds(missing[j], newcomers[i], repeatability))
        pairs.push_back({i, j, term, *odds - own});
    }
  }
  const std::vector<std::size_t> tried = likeliest_columns(pairs);
  std::vector<PossiblePair> renumbered;
  for (const PossiblePair& pair : pairs) {
    const auto at = std::ranges::lower_bound(tried, pair.theirs);
    if (at == tried.end() || *at != pair.theirs) continue;
    renumbered.push_back(pair);
    renumbered.back().theirs = static_cast<std::size_t>(at - tried.begin());
  }
  const JointMatch match = match_jointly({newcomers.size(), tried.size()}, renumbered, exact);
  return spread(match, tried, missing.size());
}

}  // namespace chorus::site
