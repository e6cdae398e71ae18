#include "common/ergonomics/doubt.h"

#include <algorithm>

namespace chorus::ergonomics {
namespace {

constexpr double kRounding = 1e-9;

std::size_t slot(int score) { return static_cast<std::size_t>(std::clamp(score, 0, kMaxScore)); }

ScoreRange score_of_person(const Method& method, const Seen& seen, const Asked& asked) {
  const ScoreRange left = score_of(method, codes_of(method, seen, Side::Left, asked));
  if (!method.sided) return left;
  return worse(left, score_of(method, codes_of(method, seen, Side::Right, asked)));
}

void normalise(Odds& odds) {
  odds[0] = 0.0;
  double sum = 0.0;
  for (const double each : odds) sum += each;
  if (sum <= 0.0) return;
  for (double& each : odds) each /= sum;
}

}  // namespace

ScoreSet set_of(const Odds& odds, double probability) {
  ScoreSet best;
  for (int from = 1; from <= kMaxScore; ++from) {
    double sum = 0.0;
    for (int to = from; to <= kMaxScore; ++to) {
      sum += odds[slot(to)];
      if (sum + kRounding < probability) continue;
      const ScoreSet set{from, to, sum};
      if (best.from == 0 || set.width() < best.width() ||
          (set.width() == best.width() && set.probability > best.probability))
        best = set;
      break;
    }
  }
  return best;
}

ScoreSet set_of(const DoubtfulScore& score, double probability) {
  const ScoreSet low = set_of(score.low, probability);
  const ScoreSet high = set_of(score.high, probability);
  return {low.from, std::max(low.to, high.to), std::min(low.probability, high.probability)};
}

std::vector<double> level_odds(const Method& method, const Odds& odds) {
  std::vector<double> levels(method.levels.size(), 0.0);
  for (int score = 1; score <= method.highest; ++score)
    levels[level_of(method, score)] += odds[slot(score)];
  return levels;
}

DoubtfulScore doubtful_score(const Method& method, const Drawn& drawn, const Asked& asked) {
  DoubtfulScore out;
  out.score = score_of_person(method, drawn.nominal, asked);
  if (method.sided) {
    for (const Side side : posture::kSides)
      out.sides[static_cast<std::size_t>(side)] =
          score_of(method, codes_of(method, drawn.nominal, side, asked));
  }
  if (!out.known()) return out;
  Seen seen = drawn.nominal;
  for (const Measures& draw : drawn.draws) {
    seen.measures = draw;
    const ScoreRange score = score_of_person(method, seen, asked);
    out.low[slot(score.low)] += 1.0;
    out.high[slot(score.high)] += 1.0;
  }
  if (drawn.draws.empty()) {
    out.low[slot(out.score.low)] = 1.0;
    out.high[slot(out.score.high)] = 1.0;
  }
  normalise(out.low);
  normalise(out.high);
  return out;
}

Odds side_odds(const Method& method, const Drawn& drawn, Side side, const Asked& asked) {
  Odds odds{};
  Seen seen = drawn.nominal;
  const auto add = [&](Side which, double weight) {
    const ScoreRange score = score_of(method, codes_of(method, seen, which, asked));
    odds[slot(score.high)] += weight;
  };
  for (const Measures& draw : drawn.draws) {
    seen.measures = draw;
    add(side, drawn.sides_confidence);
    add(posture::other(side), 1.0 - drawn.sides_confidence);
  }
  normalise(odds);
  return odds;
}

}  // namespace chorus::ergonomics
