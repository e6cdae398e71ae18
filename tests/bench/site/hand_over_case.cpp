// hand-over: two people side by side; the next cell sees one of them, or both after a gap.
#include <array>
#include <string>

#include <fmt/format.h>

#include "tests/bench/site/site_cases.h"
#include "tests/judge/hall_scenes.h"

namespace chorus::bench {
namespace {

constexpr std::size_t kDraws = 200;
constexpr std::size_t kQuickDraws = 20;
constexpr double kSpeed = 1.2;    // [m/s]
constexpr double kSettled = 3.0;  // [s] after the first sight, ids are what they will be

struct Condition {
  const char* name;
  PlaceErrors errors;
  double overlap = 1.5;      ///< [m]; negative: unseen in between.
  bool both = false;         ///< The next cell sees both, not only one of them.
  double expected_60 = 0.0;  ///< Wrong ids, as computed for the nearest of two [%].
  double expected_120 = 0.0;
};
constexpr std::array kConditions{
    Condition{"place-0.1m", {0.1, 0.5, 0.005}, 1.5, false, 0.2, 0.0},
    Condition{"place-0.2m", {0.2, 0.5, 0.005}, 1.5, false, 6.7, 0.1},
    Condition{"place-0.2m-both-seen", {0.2, 0.5, 0.005}, 1.5, true, 6.7, 0.1},
    Condition{"yaw-3deg", {0.1, 3.0, 0.005}, 1.5, false, 4.8, 0.2},
    Condition{"clocks-100ms", {0.1, 0.5, 0.1}, 1.5, false, 1.4, 0.0},
    Condition{"unseen-0.5s", {0.1, 0.5, 0.005}, -0.6, true, 13.0, 1.3},
    Condition{"unseen-2s", {0.1, 0.5, 0.005}, -2.4, true, 38.0, 28.0}};

struct Outcome {
  std::size_t wrong_at_first = 0;
  std::size_t wrong = 0;
  std::size_t wrong_unsaid = 0;
  std::size_t lost = 0;  ///< Neither's id.
  std::size_t all = 0;
};

/// One draw: the two walk abreast from the left cell into the right one.
void draw(const Condition& condition, double apart, std::uint64_t seed, Outcome& outcome) {
  auto cells = two_cells(condition.overlap, seed, condition.errors);
  if (!condition.both) {
    cells[1].blind.push_back({Eigen::Vector2d(-10, 0.5 * apart), Eigen::Vector2d(10, 10)});
  }
  const std::array people{of_own_build(straight_walker({-4, 0}, {kSpeed, 0}), seed, 0),
                          of_own_build(straight_walker({-4, apart}, {kSpeed, 0}), seed, 1)};
  Hall hall(std::move(cells), {people[0], people[1]}, seed);
  std::array<site::SiteId, 2> before;
  std::array<site::SiteId, 2> first;
  std::array<site::SiteId, 2> last;
  std::array<bool, 2> doubtful{};
  std::array<double, 2> seen{};
  while (hall.time() < 9.0) {
    hall.step();
    for (const HallWord& word : hall.words()) {
      if (word.cell == 0 && word.id) before[word.person] = *word.id;
      if (word.cell == 0) continue;
      if (seen[word.person] == 0.0) seen[word.person] = hall.time();
      if (!word.id || hall.time() > seen[word.person] + kSettled) continue;
      if (first[word.person].empty()) first[word.person] = *word.id;
      last[word.person] = *word.id;
      doubtful[word.person] = word.doubtful;
    }
  }
  for (const std::size_t person : {0U, 1U}) {
    if (last[person].empty()) continue;
    ++outcome.all;
    outcome.wrong_at_first += first[person] == before[1 - person] ? 1 : 0;
    const bool wrong = last[person] == before[1 - person];
    outcome.wrong += wrong ? 1 : 0;
    outcome.wrong_unsaid += wrong && !doubtful[person] ? 1 : 0;
    outcome.lost += !wrong && last[person] != before[person] ? 1 : 0;
  }
}

}  // namespace

void run_hand_over_case(Report& report) {
  const std::size_t draws = report.quick() ? kQuickDraws : kDraws;
  for (const Condition& condition : kConditions) {
    for (const double apart : {0.6, 1.2}) {
      Outcome outcome;
      for (std::size_t d = 0; d < draws; ++d) draw(condition, apart, report.seed() + d, outcome);
      const std::string name = fmt::format("hand-over-{}-{:.1f}m", condition.name, apart);
      const auto percent = [&](std::size_t part) {
        return 100.0 * static_cast<double>(part) / static_cast<double>(outcome.all);
      };
      const double expected = apart < 1.0 ? condition.expected_60 : condition.expected_120;
      report.row(name, "wrong_id_percent", percent(outcome.wrong), "%", "nearest",
                 percent(outcome.wrong) / expected);
      report.row(name, "wrong_at_first_percent", percent(outcome.wrong_at_first), "%");
      report.row(name, "wrong_unsaid_percent", percent(outcome.wrong_unsaid), "%");
      report.row(name, "new_id_percent", percent(outcome.lost), "%");
    }
  }
}

}  // namespace chorus::bench
