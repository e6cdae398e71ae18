#include "common/ergonomics/summary.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/ergonomics/limits.h"

namespace chorus::ergonomics {
namespace {

constexpr double kNinety = 0.9;
constexpr double kSigmas = 1.645;  // 90 % of a normal distribution
constexpr double kApart = 2.0;     // [s] between the worst moments
constexpr std::size_t kWorst = 3;
/// Errors of joints last for about half a second (docs/benchmarks/model.md), so neighbouring
/// instants do not average out, ...
constexpr double kErrorLasts = 0.5;  // [s]
/// ... and what the own stance leaves of them goes with the posture (bends are measured too small),
/// so it lasts as long as the posture does.  Measured on the two takes with Vicon of
/// docs/benchmarks/ergonomics.md.
constexpr double kLasting = 1.0;

double since(Timestamp start, Timestamp at) {
  return std::chrono::duration<double>(at - start).count();
}

std::size_t cell_of(int score) { return static_cast<std::size_t>(std::clamp(score, 0, kMaxScore)); }

/// Sums over the instants of being in a level.
struct Membership {
  double nominal = 0.0;  ///< Of the body as it is.
  double drawn = 0.0;    ///< The probability, from the drawn bodies.
  double squares = 0.0;  ///< The variance of one instant's membership.

  void add(bool in, double probability) {
    nominal += in ? 1.0 : 0.0;
    drawn += probability;
    squares += probability * (1.0 - probability);
  }
};

struct LevelSums {
  double highest = 0.0;  ///< Instants at which the highest codes of unknown inputs lead here.
  Membership least;      ///< Here, whatever the unknown inputs are.
  Membership most;       ///< Here for some of them.
};

struct Collected {
  std::vector<LevelSums> levels;
  std::vector<int> scores;
  std::array<std::vector<int>, 2> sides;
  double certain = 0.0;
};

/// Unknown inputs leave a score of `low` to `high`, so they leave the levels between these two.
void add_levels(const Method& method, const DoubtfulScore& score, std::vector<LevelSums>& sums) {
  const auto low = level_odds(method, score.low);
  const auto high = level_odds(method, score.high);
  const std::size_t from = level_of(method, score.score.low);
  const std::size_t to = level_of(method, score.score.high);
  double low_before = 0.0;
  double high_before = 0.0;
  for (std::size_t l = 0; l < sums.size(); ++l) {
    const double low_after = 1.0 - low_before - low[l];
    const double high_after = 1.0 - high_before - high[l];
    sums[l].highest += l == to ? 1.0 : 0.0;
    sums[l].least.add(from == l && to == l, std::clamp(1.0 - low_before - high_after, 0.0, 1.0));
    sums[l].most.add(from <= l && l <= to, std::clamp(1.0 - low_after - high_before, 0.0, 1.0));
    low_before += low[l];
    high_before += high[l];
  }
}

Collected collected(const ScoredPerson& person, const Method& method, std::size_t index,
                    const Slice& slice) {
  Collected sums;
  sums.levels.resize(method.levels.size());
  for (std::size_t i = slice.first; i < slice.last; ++i) {
    const DoubtfulScore& score = person.instants[i].scores[index];
    if (!score.known()) continue;
    sums.scores.push_back(score.score.high);
    add_levels(method, score, sums.levels);
    sums.certain += score.high[cell_of(set_of(score.high, kNinety).from)] >= kNinety ? 1.0 : 0.0;
    for (std::size_t side = 0; side < 2 && method.sided; ++side)
      sums.sides[side].push_back(score.sides[side].high);
  }
  return sums;
}

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// The 90 % interval of the share of time, of `n` instants that are `step` apart [s].  The drawn
/// bodies err twice, as measured and as drawn, so their shares lie as far beyond those of the
/// bodies as these lie beyond the truth.
Interval interval_of(const Membership& sums, double n, double step) {
  const double share = sums.nominal / n;
  const double centre = 2.0 * share - sums.drawn / n;
  const double doubt = sums.squares / n;
  const double together = std::max(1.0, kErrorLasts / std::max(step, 1e-3));
  const double variance = doubt * together / n + kLasting * doubt * doubt;
  const double half = kSigmas * std::sqrt(variance) + 0.5 * std::abs(centre - share);
  const double middle = 0.5 * (centre + share);
  return {std::clamp(middle - half, 0.0, share), std::clamp(middle + half, share, 1.0)};
}

std::vector<ZoneTime> times_of(const Collected& sums, double step) {
  std::vector<ZoneTime> zones(sums.levels.size());
  const double n = static_cast<double>(sums.scores.size());
  for (std::size_t l = 0; l < zones.size() && n > 0.0; ++l) {
    const LevelSums& level = sums.levels[l];
    zones[l] = {level.highest / n, level.least.nominal / n, level.most.nominal / n,
                interval_of(level.least, n, step).low, interval_of(level.most, n, step).high};
  }
  return zones;
}

int quantile(std::vector<int> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// The expected score, by which moments are compared.
double expected(const Odds& odds) {
  double sum = 0.0;
  for (std::size_t score = 1; score < odds.size(); ++score)
    sum += static_cast<double>(score) * odds[score];
  return sum;
}

std::vector<Moment> worst_of(const ScoredPerson& person, std::size_t index, const Slice& slice) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = slice.first; i < slice.last; ++i) {
    const DoubtfulScore& score = person.instants[i].scores[index];
    if (score.known()) order.emplace_back(-expected(score.high), i);
  }
  std::ranges::stable_sort(order);
  std::vector<Moment> worst;
  for (const auto& [minus, i] : order) {
    const ScoredInstant& instant = person.instants[i];
    const bool near = std::ranges::any_of(
        worst, [&](const Moment& each) { return std::abs(each.at - instant.at) < kApart; });
    if (near) continue;
    const DoubtfulScore& score = instant.scores[index];
    worst.push_back({instant.at, i, score.score, set_of(score, kNinety)});
    if (worst.size() == kWorst) break;
  }
  return worst;
}

double step_of(const ScoredPerson& person, const Slice& slice) {
  if (slice.last - slice.first < 2) return 1.0 / 30.0;
  return (person.instants[slice.last - 1].at - person.instants[slice.first].at) /
         static_cast<double>(slice.last - slice.first - 1);
}

std::vector<MovementCount> movements_of(const ScoredPerson& person) {
  using posture::index_of;
  const Limits& limit = limits();
  const std::array<std::pair<std::size_t, double>, 4> watched{
      {{index_of(Centre::TrunkFlexion), limit.en_trunk_high},
       {index_of(Centre::HeadInclination), limit.en_head},
       {index_of(Limb::UpperArmElevation, Side::Left), limit.en_upper_arm_high},
       {index_of(Limb::UpperArmElevation, Side::Right), limit.en_upper_arm_high}}};
  std::vector<MovementCount> counts;
  for (const auto& [measure, most] : watched) {
    MovementCount count{posture::name_of(measure), most, 0.0};
    bool beyond = false;
    for (const Observation& each : person.observations) {
      const double value = each.shown.values[measure];
      if (std::isnan(value)) continue;
      if (value > most && !beyond) count.per_minute += 1.0;
      beyond = value > most;
    }
    count.per_minute *= person.seconds > 0.0 ? 60.0 / person.seconds : 0.0;
    counts.push_back(count);
  }
  return counts;
}

std::vector<MethodSummary> summaries(const ScoredPerson& person, const ScoringInput& input,
                                     const Slice& slice) {
  std::vector<MethodSummary> all;
  for (std::size_t m = 0; m < input.methods.size(); ++m)
    all.push_back(summary_of(person, input, m, slice));
  return all;
}

Slice slice_of(const ScoredPerson& person, const Span& span) {
  Slice slice;
  const auto& instants = person.instants;
  while (slice.first < instants.size() && instants[slice.first].at < span.from) ++slice.first;
  slice.last = slice.first;
  while (slice.last < instants.size() && instants[slice.last].at < span.to) ++slice.last;
  return slice;
}

}  // namespace

MethodSummary summary_of(const ScoredPerson& person, const ScoringInput& input, std::size_t index,
                         const Slice& slice) {
  const Method& method = *input.methods[index];
  const Collected sums = collected(person, method, index, slice);
  MethodSummary summary;
  summary.method = &method;
  const double all = static_cast<double>(slice.last - slice.first);
  const double scored = static_cast<double>(sums.scores.size());
  if (all > 0.0) summary.scored = scored / all;
  for (std::size_t i = slice.first; i < slice.last; ++i) {
    if (person.instants[i].scores[index].known()) continue;
    const Unscored reason = person.observations[i].reason;
    const auto known = reason == Unscored::None ? Unscored::NotSeen : reason;
    summary.unscored[static_cast<std::size_t>(known)] += 1.0 / all;
  }
  summary.levels = times_of(sums, step_of(person, slice));
  summary.p50 = quantile(sums.scores, 0.5);
  summary.p90 = quantile(sums.scores, 0.9);
  for (std::size_t side = 0; side < 2; ++side)
    summary.side_p90[side] = quantile(sums.sides[side], 0.9);
  summary.certain = scored > 0.0 ? sums.certain / scored : 0.0;
  if (method.ordered) summary.worst = worst_of(person, index, slice);
  return summary;
}

ScoredPerson score_person(const ScoringInput& input) {
  ScoredPerson person;
  person.has_stance = input.stance.has_value();
  Observer observer;
  if (input.stance) observer.stance(*input.stance);
  for (const BodyAt& body : input.bodies) {
    ScoredInstant instant{since(input.start, body.at), {}};
    const Asked asked = input.task.asked_at(instant.at);
    const Observation& seen = person.observations.emplace_back(observer.observe(body));
    person.doubtless = std::max(person.doubtless, seen.doubtless);
    for (const Method* method : input.methods)
      instant.scores.push_back(score_of(*method, seen, asked));
    person.instants.push_back(std::move(instant));
  }
  if (person.instants.empty()) return person;
  person.seconds = person.instants.back().at - person.instants.front().at;
  if (input.task.cycle) person.cycles = person.seconds / *input.task.cycle;
  person.movements = movements_of(person);
  person.methods = summaries(person, input, {0, person.instants.size()});
  for (const Phase& phase : input.task.phases)
    person.phases.push_back(summaries(person, input, slice_of(person, phase.span)));
  return person;
}

}  // namespace chorus::ergonomics
