#include "tests/bench/ergonomics/posture_agreement.h"

#include <algorithm>
#include <cmath>

#include "common/ergonomics/all_methods.h"
#include "common/ergonomics/summary.h"

namespace chorus::bench {
namespace {

using ergonomics::BodyAt;
using ergonomics::Codes;
using ergonomics::Method;
using ergonomics::Observation;
using ergonomics::Observer;
using ergonomics::Side;

constexpr double kNinety = 0.9;
constexpr Duration kWindow = std::chrono::seconds(20);

std::vector<posture::Instant> instants_of(const std::vector<BodyAt>& bodies) {
  std::vector<posture::Instant> instants;
  for (const BodyAt& body : bodies)
    instants.push_back({body.at, posture::posture_of(body.body).measures});
  return instants;
}

/// The own stances as the two sides see them, of the same instants.
struct Stances {
  std::optional<posture::Neutral> found;
  std::optional<posture::Neutral> truth;
};

/// The stance over a stretch, upright or not: the protocol of a recording says when it is.
std::optional<posture::Neutral> stance_within(const std::vector<posture::Instant>& instants,
                                              const std::pair<Timestamp, Timestamp>& stretch) {
  std::vector<posture::Instant> within;
  for (const auto& each : instants) {
    if (stretch.first <= each.at && each.at <= stretch.second) within.push_back(each);
  }
  if (within.empty()) return std::nullopt;
  return posture::stance_of(within);
}

/// Where no stretch is stated, what was found says when the person stands.
Stances stances_of(const ScoredTake& take) {
  const auto found = instants_of(take.found);
  const auto truth = instants_of(take.truth);
  auto stretch = take.stance;
  if (!stretch) {
    if (const auto calm = posture::calm_stance(found)) stretch = std::pair{calm->from, calm->until};
  }
  if (stretch) return {stance_within(found, *stretch), stance_within(truth, *stretch)};
  return {posture::standing_stance(found, found), posture::standing_stance(truth, found)};
}

std::vector<Observation> observed(const std::vector<BodyAt>& bodies, const PostureOptions& options,
                                  const std::optional<posture::Neutral>& stance) {
  Observer observer({.held = options.held});
  if (options.stance && stance) observer.stance(*stance);
  std::vector<Observation> all;
  for (const BodyAt& body : bodies) all.push_back(observer.observe(body));
  return all;
}

int person_score(const Method& method, const Observation& seen) {
  if (seen.reason != ergonomics::Unscored::None) return 0;
  const auto asked = empty_hands();
  const auto left = score_of(method, codes_of(method, seen.seen, Side::Left, asked));
  if (!method.sided) return left.high;
  return worse(left, score_of(method, codes_of(method, seen.seen, Side::Right, asked))).high;
}

void add_codes(const Observation& found, const Observation& truth, PostureAgreement& sum) {
  const auto asked = empty_hands();
  const auto pair = [&](const Method& method, std::size_t input, Side side, std::size_t figure) {
    const int a = codes_of(method, found.seen, side, asked)[input];
    const int b = codes_of(method, truth.seen, side, asked)[input];
    if (a > 0 && b > 0) sum.of[figure].add(a, b);
  };
  for (const Side side : posture::kSides) pair(ergonomics::kReba, 3, side, 2);
  pair(ergonomics::kReba, 0, Side::Left, 3);
  pair(ergonomics::kReba, 1, Side::Left, 4);
  pair(ergonomics::kReba, 2, Side::Left, 5);
  for (std::size_t i = 0; i < 3; ++i) pair(ergonomics::kOwas, i, Side::Left, 6 + i);
}

void add_doubt(const Observation& found, int truth, PostureAgreement& sum) {
  const auto score = score_of(ergonomics::kReba, found, empty_hands());
  const auto set = set_of(score, kNinety);
  sum.covered += set.from <= truth && truth <= set.to ? 1.0 : 0.0;
  sum.width += set.width();
  sum.within_one += std::abs(score.score.high - truth) <= 1 ? 1.0 : 0.0;
  for (int s = 1; s <= ergonomics::kMaxScore; ++s) {
    if (score.high[static_cast<std::size_t>(s)] <= kNinety) continue;
    sum.sure += 1.0;
    sum.sure_right += s == truth ? 1.0 : 0.0;
  }
}

/// Of each window, whether the stated interval of each level's share holds the true share.
void add_zones(const ScoredTake& take, const std::vector<Observation>& truth,
               const std::optional<posture::Neutral>& stance, PostureAgreement& sum) {
  const std::vector<const Method*> methods{&ergonomics::kReba, &ergonomics::kOwas};
  ergonomics::Task task;
  task.asked = empty_hands();
  const ergonomics::ScoringInput input{take.found, methods, task, take.found.front().at, stance};
  const auto person = ergonomics::score_person(input);
  for (std::size_t first = 0; first < take.found.size();) {
    std::size_t last = first;
    while (last < take.found.size() && take.found[last].at - take.found[first].at < kWindow) ++last;
    if (last == take.found.size()) break;
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const auto summary = summary_of(person, input, m, {first, last});
      std::vector<double> share(methods[m]->levels.size(), 0.0);
      double count = 0.0;
      for (std::size_t i = first; i < last; ++i) {
        const int score = person_score(*methods[m], truth[i]);
        if (score == 0) continue;
        share[level_of(*methods[m], score)] += 1.0;
        count += 1.0;
      }
      for (std::size_t l = 0; l < share.size() && count > 0.0; ++l) {
        const auto& zone = summary.levels[l];
        sum.zones += 1.0;
        sum.zone_width += zone.high - zone.low;
        const double is = share[l] / count;
        sum.zones_held += zone.low - 1e-9 <= is && is <= zone.high + 1e-9 ? 1.0 : 0.0;
      }
    }
    first = last;
  }
}

}  // namespace

double Agreement::weighted(bool squares) const {
  if (pairs_.empty()) return kNoRatio;
  std::array<double, 16> rows{};
  std::array<double, 16> columns{};
  const double n = static_cast<double>(pairs_.size());
  const auto weight = [&](int a, int b) {
    return squares ? static_cast<double>((a - b) * (a - b)) : a == b ? 0.0 : 1.0;
  };
  double seen = 0.0;
  for (const auto& [a, b] : pairs_) {
    rows[static_cast<std::size_t>(a)] += 1.0 / n;
    columns[static_cast<std::size_t>(b)] += 1.0 / n;
    seen += weight(a, b) / n;
  }
  double expected = 0.0;
  for (int a = 0; a < 16; ++a) {
    for (int b = 0; b < 16; ++b)
      expected +=
          weight(a, b) * rows[static_cast<std::size_t>(a)] * columns[static_cast<std::size_t>(b)];
  }
  return expected > 0.0 ? 1.0 - seen / expected : kNoRatio;
}

ergonomics::Asked empty_hands() {
  ergonomics::Asked asked;
  asked.load_kg = 0.0;
  asked.coupling = ergonomics::Coupling::Good;
  asked.wrist = ergonomics::Wrist::Straight;
  asked.shock = asked.wrist_twisted = asked.arm_supported = false;
  asked.held_over_minute = asked.repeated = asked.unstable = false;
  return asked;
}

namespace {

/// A neck is compared with one that is measured in the same way: without a true orientation of the
/// head, the found one is left out.
ScoredTake with_like_heads(ScoredTake take) {
  const auto turned = [](const BodyAt& body) { return posture::head_of(body.body).has_value(); };
  if (std::ranges::any_of(take.truth, turned)) return take;
  for (BodyAt& body : take.found) body.body[JointId::Head].orientation.coeffs().setZero();
  return take;
}

}  // namespace

void compare_postures(const ScoredTake& compared, const PostureOptions& options,
                      PostureAgreement& sum) {
  const ScoredTake take = with_like_heads(compared);
  const Stances stances = stances_of(take);
  const auto found = observed(take.found, options, stances.found);
  const auto truth = observed(take.truth, options, stances.truth);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const int exact = person_score(ergonomics::kReba, truth[i]);
    if (exact == 0) continue;
    sum.asked += 1.0;
    const int score = person_score(ergonomics::kReba, found[i]);
    if (score == 0) continue;
    sum.scored += 1.0;
    sum.of[0].add(score, exact);
    const auto level = [](int s) { return static_cast<int>(level_of(ergonomics::kReba, s)); };
    sum.of[1].add(level(score), level(exact));
    add_codes(found[i], truth[i], sum);
    const int owas = person_score(ergonomics::kOwas, found[i]);
    const int owas_exact = person_score(ergonomics::kOwas, truth[i]);
    if (owas > 0 && owas_exact > 0) sum.of[9].add(owas, owas_exact);
    const int posture = person_score(ergonomics::kEaws, found[i]);
    const int posture_exact = person_score(ergonomics::kEaws, truth[i]);
    if (posture > 0 && posture_exact > 0) sum.of[10].add(posture, posture_exact);
    add_doubt(found[i], exact, sum);
  }
  if (options.held && !take.found.empty())
    add_zones(take, truth, options.stance ? stances.found : std::nullopt, sum);
}

void report_agreement(Report& report, const std::string& name, const PostureAgreement& sum) {
  for (std::size_t f = 0; f < kPostureFigures.size(); ++f) {
    const std::string figure = kPostureFigures[f];
    report.row(name, figure + "_kappa", sum.of[f].kappa(), "");
    report.row(name, figure + "_weighted_kappa", sum.of[f].weighted_kappa(), "");
  }
  report.row(name, "scored_percent", 100.0 * sum.scored / std::max(1.0, sum.asked), "%");
}

void report_doubt(Report& report, const std::string& name, const PostureAgreement& sum) {
  const double n = std::max(1.0, sum.scored);
  report.row(name, "covered_percent", 100.0 * sum.covered / n, "%", "score +-1",
             sum.covered / std::max(1.0, sum.within_one));
  report.row(name, "set_width", sum.width / n, "scores", "score +-1", sum.width / n / 3.0);
  report.row(name, "sure_percent", 100.0 * sum.sure / n, "%");
  report.row(name, "sure_right_percent", 100.0 * sum.sure_right / std::max(1.0, sum.sure), "%");
  if (sum.zones == 0.0) return;
  report.row(name, "zones_held_percent", 100.0 * sum.zones_held / sum.zones, "%");
  report.row(name, "zone_width_points", 100.0 * sum.zone_width / sum.zones, "points");
}

}  // namespace chorus::bench
