#include "fusion-server/site/joint_match.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace chorus::site {
namespace {

constexpr std::size_t kHypotheses = 100;
constexpr double kHopeless = -15.0;  // log likelihood ratio below which a pair is not tried
constexpr std::size_t kNobody = kMatchColumns;

/// An assignment of the people that were gone through so far.
struct Hypothesis {
  double log = 0.0;
  CommonError error;
  std::uint64_t used = 0;           ///< Theirs, as bits: kMatchColumns of them.
  std::vector<std::size_t> theirs;  ///< Of each of ours; kNobody: none.
};

using Row = std::vector<const PossiblePair*>;

void branch(const Hypothesis& from, const Row& row, std::vector<Hypothesis>& to) {
  Hypothesis alone = from;
  alone.theirs.push_back(kNobody);
  for (const PossiblePair* pair : row) {
    const std::uint64_t bit = std::uint64_t{1} << pair->theirs;
    if ((from.used & bit) != 0) continue;
    const double gain = log_density(from.error, pair->term) + pair->rest;
    if (!(gain > kHopeless)) continue;
    Hypothesis next = from;
    next.log += gain;
    next.error = updated(from.error, pair->term);
    next.used |= bit;
    next.theirs.push_back(pair->theirs);
    to.push_back(std::move(next));
  }
  to.push_back(std::move(alone));
}

void keep_best(std::vector<Hypothesis>& all) {
  std::ranges::sort(all, std::greater{}, &Hypothesis::log);
  if (all.size() > kHypotheses) all.resize(kHypotheses);
}

std::vector<Hypothesis> hypotheses_of(const std::vector<Row>& rows, const CommonError& error) {
  std::vector<Hypothesis> all(1);
  all.front().error = error;
  for (const Row& row : rows) {
    std::vector<Hypothesis> next;
    for (const Hypothesis& each : all) branch(each, row, next);
    keep_best(next);
    all = std::move(next);
  }
  return all;
}

}  // namespace

Likeliest likeliest_of(const JointMatch& match, std::size_t ours,
                       const std::function<bool(std::size_t)>& allowed) {
  Likeliest best{{}, match.none[ours]};
  for (std::size_t j = 0; j < match.columns; ++j) {
    if (match.at(ours, j) > best.probability && allowed(j)) best = {j, match.at(ours, j)};
  }
  return best;
}

JointMatch match_jointly(MatchSize size, std::span<const PossiblePair> pairs,
                         const CommonError& error) {
  std::vector<Row> rows(size.ours);
  for (const PossiblePair& pair : pairs) {
    if (pair.ours < size.ours && pair.theirs < std::min(size.theirs, kMatchColumns))
      rows[pair.ours].push_back(&pair);
  }
  const std::vector<Hypothesis> all = hypotheses_of(rows, error);
  JointMatch match{size.theirs, std::vector<double>(size.ours * size.theirs, 0.0),
                   std::vector<double>(size.ours, 0.0)};
  double sum = 0.0;
  for (const Hypothesis& each : all) sum += std::exp(each.log - all.front().log);
  for (const Hypothesis& each : all) {
    const double weight = std::exp(each.log - all.front().log) / sum;
    for (std::size_t i = 0; i < size.ours; ++i) {
      if (each.theirs[i] == kNobody)
        match.none[i] += weight;
      else
        match.pairs[i * size.theirs + each.theirs[i]] += weight;
    }
  }
  return match;
}

}  // namespace chorus::site
