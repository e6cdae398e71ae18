#include "fusion-server/associate/assignment.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include <gtest/gtest.h>

namespace chorus::associate {
namespace {

using Answer = std::vector<std::optional<std::size_t>>;

TEST(Assign, PrefersTheLeastTotalOverTheGreedyChoice) {
  const CostTable table{2, 2, {0.1, 0.2, 0.15, 0.9}, 1.0};
  EXPECT_EQ(assign(table), (Answer{1, 0}));  // 0.35 beats 0.1 + 0.9
}

TEST(Assign, NeverPairsBeyondTheGate) {
  EXPECT_EQ(assign({1, 1, {0.7}, 0.6}), Answer{std::nullopt});
  EXPECT_EQ(assign({2, 1, {0.7, 0.5}, 0.6}), (Answer{std::nullopt, 0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(assign({1, 2, {nan, 0.5}, 0.6}), Answer{1});
}

TEST(Assign, EmptySidesAreFine) {
  EXPECT_TRUE(assign({0, 3, {}, 1.0}).empty());
  EXPECT_EQ(assign({2, 0, {}, 1.0}), (Answer{std::nullopt, std::nullopt}));
}

/// Tries all assignments; returns the largest number of pairs, and the smallest cost of that many.
std::pair<std::size_t, double> best_by_trying(const CostTable& table) {
  const std::size_t size = std::max(table.rows, table.columns);
  std::vector<std::size_t> order(size);
  std::iota(order.begin(), order.end(), 0);
  std::pair<std::size_t, double> best{0, 0.0};
  do {
    std::pair<std::size_t, double> made{0, 0.0};
    for (std::size_t row = 0; row < table.rows; ++row) {
      if (order[row] >= table.columns || table.at(row, order[row]) > table.gate) continue;
      ++made.first;
      made.second += table.at(row, order[row]);
    }
    const bool better =
        made.first > best.first || (made.first == best.first && made.second < best.second);
    if (better) best = made;
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TEST(AssignProperty, EqualsTryingEverything) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> cost(0.0, 1.0);
  std::uniform_int_distribution<std::size_t> count(1, 5);
  for (int round = 0; round < 300; ++round) {
    CostTable table{count(random), count(random), {}, 0.6};
    for (std::size_t i = 0; i < table.rows * table.columns; ++i) table.cost.push_back(cost(random));
    std::pair<std::size_t, double> made{0, 0.0};
    const Answer answer = assign(table);
    for (std::size_t row = 0; row < table.rows; ++row) {
      if (!answer[row]) continue;
      ++made.first;
      made.second += table.at(row, *answer[row]);
    }
    const auto best = best_by_trying(table);
    EXPECT_EQ(made.first, best.first);
    EXPECT_NEAR(made.second, best.second, 1e-9);
  }
}

TEST(Assign, LeavesARowAloneWhenThatCostsLess) {
  // Two pairs cost 1.8; one pair and an unassigned row cost 1.1.
  CostTable table{2, 2, {0.1, 0.9, 0.9, 2.0}, 1.0};
  EXPECT_EQ(assign(table)[1], 0u);
  table.unpaired = 1.0;
  EXPECT_EQ(assign(table)[0], 0u);
  EXPECT_FALSE(assign(table)[1]);
}

}  // namespace
}  // namespace chorus::associate
