#include "fusion-server/site/matching.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace chorus::site {
namespace {

// Samples are this far apart; nearer ones have the same errors.
constexpr Duration kSampleApart = std::chrono::milliseconds(90);
constexpr double kNearby = 3.0;  // [m] apart in the site; two bodies farther apart are two people
// Two people who are not one would be anywhere in this area [m^2]: as dense as a busy hall.
constexpr double kArea = 10.0;
// Lengths that differ prove much, but they may be of a bad view; lengths that agree prove less.
constexpr double kLengthsAgainst = 8.0;
constexpr double kLengthsFor = 4.0;
constexpr double kMostUnsteady = 8.0;
// Log odds that two bodies of one name are one person, and that two of different names are.
constexpr double kSameName = 4.0;
constexpr double kOtherName = -2.0;
constexpr double kSure = 0.97;    // probability from which on a pair teaches
constexpr double kUsual = 9.21;   // chi^2 with two degrees of freedom, 99 %: what teaches at most
constexpr double kEnough = 0.45;  // [s] of evidence

Eigen::Vector2d on_floor(const Eigen::Vector3d& x) { return {x.x(), x.z()}; }

Eigen::Matrix2d on_floor(const Eigen::Matrix3d& c) {
  Eigen::Matrix2d floor;
  floor << c(0, 0), c(0, 2), c(2, 0), c(2, 2);
  return floor;
}

PairSample pair_sample(const Sample& ours, const Sample& theirs) {
  PairSample sample{ours.at};
  sample.off = on_floor(ours.place) - on_floor(theirs.place);
  sample.place = on_floor(theirs.place);
  sample.velocity = on_floor(theirs.velocity);
  sample.covariance = on_floor(ours.covariance) + on_floor(theirs.covariance);
  return sample;
}

/// Samples of both at the instants of `theirs` that are new.
void sample_pair(const HeardCell& ours, const HeardCell& theirs, const BodyPair& pair,
                 PairWindow& window) {
  const Trail& trail = ours.bodies.at(pair.first).trail;
  for (const Sample& sample : theirs.bodies.at(pair.second).trail.samples()) {
    if (sample.at < window.newest() + kSampleApart) continue;
    const auto own = trail.at(sample.at);
    if (!own) continue;
    const PairSample both = pair_sample(in_site(ours.place->site_from_cell, *own),
                                        in_site(theirs.place->site_from_cell, sample));
    if (both.off.norm() < kNearby) window.add(both);
  }
}

double name_odds(const NamesInUse& names, const BodyPair& pair) {
  const auto one = names.ours.find(pair.first);
  const auto other = names.theirs.find(pair.second);
  if (one == names.ours.end() || other == names.theirs.end()) return 0.0;
  if (one->second.id.empty() || other->second.id.empty()) return 0.0;
  if (!one->second.sure || !other->second.sure) return 0.0;
  return one->second.id == other->second.id ? kSameName : kOtherName;
}

double rest_of(const HeardCell& ours, const HeardCell& theirs, const BodyPair& pair) {
  const double lengths =
      associate::likeness(ours.bodies.at(pair.first).last.lengths,
                          theirs.bodies.at(pair.second).last.lengths, theirs.repeatability);
  return std::log(kArea) + std::clamp(lengths, -kLengthsAgainst, kLengthsFor);
}

std::vector<PersonId> bodies_of(const HeardCell& cell) {
  std::vector<PersonId> all;
  for (const auto& [id, body] : cell.bodies) all.push_back(id);
  return all;
}

std::size_t place_in(const std::vector<PersonId>& all, PersonId id) {
  return static_cast<std::size_t>(std::ranges::lower_bound(all, id) - all.begin());
}

}  // namespace

void sample_pairs(const HeardCell& ours, HeardCell& theirs) {
  if (!ours.place || !theirs.place) return;
  for (const auto& [own, own_body] : ours.bodies) {
    if (!own_body.seen()) continue;
    for (const auto& [other, other_body] : theirs.bodies) {
      if (!other_body.seen()) continue;
      sample_pair(ours, theirs, {own, other}, theirs.windows[{own, other}]);
    }
  }
  std::erase_if(theirs.windows, [&](const auto& each) {
    return !ours.bodies.contains(each.first.first) || each.second.newest() == Timestamp{};
  });
}

void match_cells(const HeardCell& ours, HeardCell& theirs, const NamesInUse& names,
                 const Moment& moment) {
  const std::vector<PersonId> rows = bodies_of(ours);
  const std::vector<PersonId> columns = bodies_of(theirs);
  std::vector<PossiblePair> pairs;
  std::vector<BodyPair> which;
  for (const auto& [pair, window] : theirs.windows) {
    const auto evidence = window.evidence(theirs.error, moment.now, moment.config);
    if (!evidence || !theirs.bodies.contains(pair.second)) continue;
    const double rest = rest_of(ours, theirs, pair) + name_odds(names, pair) +
                        std::max(-kMostUnsteady, evidence->unsteady);
    pairs.push_back(
        {place_in(rows, pair.first), place_in(columns, pair.second), evidence->term, rest});
    which.push_back(pair);
  }
  const JointMatch match = match_jointly({rows.size(), columns.size()}, pairs, theirs.error);
  theirs.likely.clear();
  for (std::size_t k = 0; k < pairs.size(); ++k)
    theirs.likely[which[k]] = match.at(pairs[k].ours, pairs[k].theirs);
}

void learn_from_matches(const HeardCell& ours, HeardCell& theirs, const NamesInUse& names,
                        const Moment& moment) {
  const Timestamp now = moment.now;
  constexpr Duration kPeriod = std::chrono::seconds(1);
  if (now - theirs.learned_at < kPeriod) return;
  const double elapsed = theirs.learned_at == Timestamp{} ? 0.0 : seconds(now - theirs.learned_at);
  theirs.learned_at = now;
  drift(theirs.error, std::min(elapsed, 3600.0));
  for (const auto& [pair, probability] : theirs.likely) {
    if (probability < kSure || name_odds(names, pair) != kSameName) continue;
    const auto evidence = theirs.windows.at(pair).evidence(theirs.error, moment.now, moment.config);
    if (!evidence || evidence->seconds < kEnough) continue;
    const CommonTerm& term = evidence->term;
    const Eigen::Vector2d off = term.off - term.lever * theirs.error.mean;
    const Eigen::Matrix2d spread =
        term.lever * theirs.error.covariance * term.lever.transpose() + term.noise;
    if (off.dot(spread.inverse() * off) > kUsual) continue;
    theirs.error = updated(theirs.error, term);
    theirs.learned += 1.0;
    theirs.repeatability.learn(ours.bodies.at(pair.first).last.lengths,
                               theirs.bodies.at(pair.second).last.lengths);
  }
}

double likely_pair(const HeardCell& theirs, const BodyPair& pair) {
  const auto found = theirs.likely.find(pair);
  return found == theirs.likely.end() ? 0.0 : found->second;
}

double seen_together(const HeardCell& theirs, const BodyPair& pair) {
  const auto found = theirs.windows.find(pair);
  if (found == theirs.windows.end()) return 0.0;
  return seconds(found->second.newest() - found->second.first());
}

}  // namespace chorus::site
