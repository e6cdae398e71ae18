#include "fusion-server/site/last_seen.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <Eigen/LU>

namespace chorus::site {
namespace {

// People out of sight walk on, slow down and turn.  Each axis of their velocity is an
// Ornstein-Uhlenbeck process, which forgets with this time constant [s], as in associate, ...
constexpr double kSlowDown = 2.0;
// ... and has this variance in the long run [m^2/s^2]: people stand or walk at up to 1.5 m/s.
constexpr double kWalking = 0.5;
// The velocity of half a second, of whose middle it is, and how a person moves meanwhile [m/s].
constexpr double kRoughVelocity = 0.3;
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
// Older visits of a person are not kept.
constexpr std::size_t kMostVisits = 8;
// However many visits: the variance of a length that clothes and sensors leave [ln^2 m].
constexpr double kLeast = 1e-4;

/// What is expected of one axis of a person's place and velocity after a time out of sight.
struct Expected {
  double way = 0.0;        ///< How far they have come, per unit of the velocity before [s].
  double remaining = 0.0;  ///< Share of the velocity that is left.
  double place = 0.0;      ///< Variance [m^2].
  double velocity = 0.0;   ///< Variance [m^2/s^2].
  double both = 0.0;       ///< Covariance [m^2/s].
};

Expected after(double unseen) {
  const double left = std::exp(-unseen / kSlowDown);
  Expected all;
  all.remaining = left;
  all.way = kSlowDown * (1.0 - left);
  all.place = kWalking * kSlowDown * kSlowDown *
              (2.0 * unseen / kSlowDown - 3.0 + 4.0 * left - left * left);
  all.velocity = kWalking * (1.0 - left * left);
  all.both = kWalking * kSlowDown * (1.0 - left) * (1.0 - left);
  return all;
}

double log_normal(const Eigen::Vector2d& off, const Eigen::Matrix2d& covariance) {
  return -0.5 * off.dot(covariance.inverse() * off) - 0.5 * std::log(covariance.determinant()) -
         std::log(2.0 * std::numbers::pi);
}

double log_normal(double off, double variance) {
  return -0.5 * (off * off / variance + std::log(2.0 * std::numbers::pi * variance));
}

/// Log density of the newcomer's place along one axis of the floor, and, if it is known, of their
/// velocity; the latter against that of anybody.
double on_axis(const LastSight& missing, const Newcomer& newcomer, const Expected& expected,
               Eigen::Index axis) {
  const double off =
      newcomer.place[axis] - missing.place[axis] - expected.way * missing.velocity[axis];
  const double stated = 0.5 * (missing.covariance(0, 0) + missing.covariance(2, 2));
  const double place = expected.place + kRough * kRough + std::min(1.0, stated);
  if (!newcomer.velocity) return log_normal(off, place);
  const double came = (*newcomer.velocity)[axis];
  const double rough = kRoughVelocity * kRoughVelocity;
  Eigen::Matrix2d covariance;
  covariance << place, expected.both, expected.both, expected.velocity + rough;
  return log_normal({off, came - expected.remaining * missing.velocity[axis]}, covariance) -
         log_normal(came, kWalking + rough);
}

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

void learn(LastSight& sight, const Visit& visit) {
  const auto known = std::ranges::find_if(sight.visits, [&](const Visit& each) {
    return each.cell == visit.cell && each.body == visit.body;
  });
  if (known == sight.visits.end()) {
    sight.visits.push_back(visit);
    if (sight.visits.size() > kMostVisits) sight.visits.erase(sight.visits.begin());
  } else {
    known->lengths = visit.lengths;
  }
  for (std::size_t i = 0; i < associate::kSpans; ++i) {
    double weights = 0.0;
    double sum = 0.0;
    for (const Visit& each : sight.visits) {
      if (!(each.lengths.variance[i] > 0)) continue;
      weights += 1.0 / each.lengths.variance[i];
      sum += each.lengths.mean[i] / each.lengths.variance[i];
    }
    sight.lengths.mean[i] = weights > 0 ? sum / weights : 0.0;
    sight.lengths.variance[i] = weights > 0 ? std::max(kLeast, 1.0 / weights) : 0.0;
  }
}

void remember(LastSights& sights, const SiteId& id, const LastSight& sight) {
  if (sights.size() >= kMostSights && !sights.contains(id)) return;
  const auto [at, fresh] = sights.try_emplace(id, sight);
  if (fresh || !(at->second.at < sight.at)) return;
  LastSight newer = sight;
  if (!at->second.visits.empty()) {
    newer.lengths = at->second.lengths;
    newer.visits = std::move(at->second.visits);
  }
  at->second = std::move(newer);
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
  const Eigen::Vector3d way = newcomer.place - missing.place;
  if (std::hypot(way.x(), way.z()) > kReach + kFastestWalk * unseen) return std::nullopt;
  const Expected expected = after(unseen);
  const double density =
      on_axis(missing, newcomer, expected, 0) + on_axis(missing, newcomer, expected, 2);
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
