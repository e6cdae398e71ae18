#include "common/ergonomics/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "common/base/units.h"
#include "common/ergonomics/limits.h"
#include "common/ergonomics/niosh.h"

namespace chorus::ergonomics {
namespace {

using ::testing::HasSubstr;
using Cells = std::map<std::string, std::vector<int>>;

/// "RULA A" -> its cells, of the second transcription.
Cells second_transcription() {
  std::ifstream file("tests/golden/ergonomics/second_transcription.txt");
  Cells cells;
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    std::string method, table, digits;
    words >> method >> table;
    while (words >> digits) {
      for (const char digit : digits)
        cells[method + " " + table].push_back(digit >= 'a' ? 10 + digit - 'a' : digit - '0');
    }
  }
  return cells;
}

Cells first_transcription() {
  const PrintedTables& tables = printed_tables();
  return {{"RULA A", tables.rula_a.cells()}, {"RULA B", tables.rula_b.cells()},
          {"RULA C", tables.rula_c.cells()}, {"REBA A", tables.reba_a.cells()},
          {"REBA B", tables.reba_b.cells()}, {"REBA C", tables.reba_c.cells()},
          {"OWAS AC", tables.owas.cells()}};
}

TEST(PrintedTables, EqualTheSecondTranscriptionInEveryCell) {
  const Cells second = second_transcription();
  const Cells first = first_transcription();
  std::size_t count = 0;
  for (const auto& [name, cells] : first) {
    ASSERT_TRUE(second.contains(name)) << name;
    EXPECT_EQ(cells, second.at(name)) << name;
    count += cells.size();
  }
  EXPECT_EQ(first.size(), second.size());
  EXPECT_EQ(count, 144u + 72 + 56 + 60 + 36 + 144 + 252);
}

TEST(PrintedTables, AMutatedCellIsNoticed) {
  const Cells second = second_transcription();
  std::mt19937_64 random(40);
  for (int n = 0; n < 40; ++n) {
    Cells mutated = first_transcription();
    auto table = std::next(mutated.begin(), static_cast<std::ptrdiff_t>(random() % mutated.size()));
    int& cell = table->second[random() % table->second.size()];
    cell += random() % 2 == 0 ? 1 : -1;
    EXPECT_NE(mutated, second) << table->first;
  }
}

TEST(PrintedTables, LookUpsOfPublishedCases) {
  const PrintedTables& tables = printed_tables();
  EXPECT_EQ(tables.rula_a.at(2, 2, 2, 1), 3);
  EXPECT_EQ(tables.rula_a.at(6, 3, 4, 2), 9);
  EXPECT_EQ(tables.rula_b.at(2, 3, 2), 5);
  EXPECT_EQ(tables.rula_c.at(8, 7), 7);
  EXPECT_EQ(tables.rula_c.at(11, 12), 7) << "beyond the table counts as its edge";
  EXPECT_EQ(tables.reba_a.at(2, 3, 3), 6);
  EXPECT_EQ(tables.reba_b.at(2, 3, 2), 5);
  EXPECT_EQ(tables.reba_c.at(5, 5), 6);
  EXPECT_EQ(tables.owas.at(3, 3, 7, 3), 1);
  EXPECT_EQ(tables.owas.at(4, 1, 3, 2), 2);
}

TEST(PrintedTables, ABrokenFileIsRefusedWithItsLine) {
  EXPECT_THAT(read_tables("table A x 2 y 2\n1 2\n3\n", "f").error().message,
              HasSubstr("3 cells, not 4"));
  EXPECT_EQ(read_tables("table A x 2 y 1\n1 z\n", "f").error().context, "f:2");
  EXPECT_FALSE(read_tables("1 2\n", "f"));
  EXPECT_FALSE(read_tables("table A x zero\n", "f"));
}

TEST(Limits, AreAllStatedWithUnitAndSource) {
  EXPECT_NEAR(limits().reba_trunk_high, deg(60), 1e-12);
  EXPECT_NEAR(limits().foot_lifted, 0.10, 1e-12);
  EXPECT_GT(limit_rows().size(), 40u);
  for (const auto& row : limit_rows()) EXPECT_GT(row.source.size(), 4u) << row.name;
  EXPECT_FALSE(read_limits("upright 5 deg ours\n", "f")) << "the others are missing";
  EXPECT_THAT(read_limits("nothing 5 deg ours\n", "f").error().message, HasSubstr("no limit"));
}

/// The multipliers as the Applications Manual prints them, in inches and pounds: its 10 in and 51
/// lb are 25 cm and 23 kg here, so that HM and the weights are 2 to 4 % smaller.
void expect_printed(const LiftLimit& limit, const std::array<double, 6>& printed, double pounds) {
  EXPECT_NEAR(limit.hm, printed[0], 0.016);
  EXPECT_NEAR(limit.vm, printed[1], 0.006);
  EXPECT_NEAR(limit.dm, printed[2], 0.006);
  EXPECT_NEAR(limit.am, printed[3], 0.006);
  EXPECT_NEAR(limit.fm, printed[4], 1e-9);
  EXPECT_NEAR(limit.cm, printed[5], 1e-9);
  EXPECT_NEAR(limit.weight_kg / 0.45359 / pounds, 0.97, 0.02);
}

TEST(LiftingEquation, PunchPressStockAsPrinted) {
  Lift lift;
  lift.horizontal = 23 * 0.0254;
  lift.vertical = 15 * 0.0254;
  lift.distance = 48 * 0.0254;
  lift.coupling = Coupling::Fair;
  expect_printed(lift_limit(lift), {0.44, 0.89, 0.86, 1.0, 1.0, 0.95}, 16.3);
  lift.vertical = 63 * 0.0254;
  expect_printed(lift_limit(lift), {0.44, 0.75, 0.86, 1.0, 1.0, 1.0}, 14.5);
}

TEST(LiftingEquation, BagsIntoAHopperAsPrinted) {
  Lift lift;
  lift.horizontal = 18 * 0.0254;
  lift.vertical = 15 * 0.0254;
  lift.distance = 21 * 0.0254;
  lift.asymmetry = deg(45);
  lift.coupling = Coupling::Fair;
  expect_printed(lift_limit(lift), {0.56, 0.89, 0.91, 0.86, 1.0, 0.95}, 18.9);
}

TEST(LiftingEquation, NothingOutsideItsRange) {
  EXPECT_NEAR(lift_limit({}).weight_kg, 23.0, 1e-9);
  EXPECT_EQ(lift_limit({0.64, 0.75, 0.25}).weight_kg, 0.0);
  EXPECT_EQ(lift_limit({0.25, 1.8, 0.25}).weight_kg, 0.0);
  EXPECT_EQ(lift_limit({0.25, 0.75, 0.25, deg(136)}).weight_kg, 0.0);
  EXPECT_EQ(lift_limit({std::nan(""), 0.75, 0.25}).weight_kg, 0.0);
  EXPECT_TRUE(std::isinf(lifting_index(1.0, lift_limit({0.64, 0.75, 0.25}))));
  Lift often;
  often.per_minute = 9;
  often.hours = 8;
  EXPECT_NEAR(lift_limit(often).fm, 0.15, 1e-9) << "hands at or above 75 cm";
  often.vertical = 0.7;
  EXPECT_EQ(lift_limit(often).fm, 0.0);
  often.per_minute = 2.5;
  EXPECT_NEAR(lift_limit(often).fm, 0.60, 1e-9) << "between 0.65 and 0.55";
}

}  // namespace
}  // namespace chorus::ergonomics
