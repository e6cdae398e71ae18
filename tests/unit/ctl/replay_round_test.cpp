#include "services/ctl/record/replay_round.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::ctl {
namespace {

using chorus::testing::kStart;
using ::testing::HasSubstr;

record::SensorStay stay(const char* sensor, Duration begin, Duration length) {
  record::SensorStay one;
  one.about.sensor = chorus::testing::sensor_id(sensor);
  one.files = {std::string(sensor) + ".mcap"};
  one.first = kStart + begin;
  one.last = one.first + length;
  return one;
}

/// A stay with the notes that importers write.
record::SensorStay imported(const char* sensor, Duration begin, const std::string& time) {
  auto one = stay(sensor, begin, std::chrono::seconds(10));
  one.about.notes = {
      {"set_origin", to_iso8601(one.first)}, {"set_period_ns", "10033000000"}, {"time", time}};
  return one;
}

TEST(ReplayRound, RecordingsMadeByTheSensorsThemselvesShareTheirBeginning) {
  const auto plan = plan_round({stay("s1", std::chrono::seconds(3), std::chrono::seconds(10)),
                                stay("s2", std::chrono::seconds(0), std::chrono::seconds(8))});
  ASSERT_TRUE(plan.round);
  EXPECT_EQ(plan.round->origin, kStart) << "s1 begins three seconds after s2, in the replay too";
  EXPECT_GT(plan.round->period, std::chrono::seconds(13));
  EXPECT_LT(plan.round->period, std::chrono::seconds(13) + std::chrono::milliseconds(100));
  EXPECT_EQ(plan.note, "");
}

TEST(ReplayRound, ACellSharesItsBeginningEvenWhenOneSensorIsLeft) {
  std::vector<record::SensorStay> cell{
      stay("s1", std::chrono::seconds(3), std::chrono::seconds(10)),
      stay("s2", std::chrono::seconds(0), std::chrono::seconds(1))};
  for (auto& one : cell) one.cell = true;
  const auto plan = plan_round(cell);
  ASSERT_TRUE(plan.round);
  EXPECT_EQ(plan.round->origin, kStart);
  EXPECT_EQ(plan.note, "") << "a sensor may have left before another came";
  cell.pop_back();
  EXPECT_TRUE(plan_round(cell).round);
}

TEST(ReplayRound, OneStreamAloneAndFilesOfOneImportNeedNone) {
  EXPECT_FALSE(plan_round({}).round);
  EXPECT_FALSE(plan_round({stay("s1", std::chrono::seconds(3), std::chrono::seconds(10))}).round);
  std::vector<record::SensorStay> both{imported("s1", std::chrono::seconds(0), "UTC as recorded"),
                                       imported("s2", std::chrono::seconds(3), "UTC as recorded")};
  both[1].about.notes["set_origin"] = both[0].about.notes["set_origin"];
  EXPECT_FALSE(plan_round(both).round);
  EXPECT_EQ(plan_round(both).note, "");
}

TEST(ReplayRound, SeparateImportsWithUtcKeepTheirCommonTime) {
  const auto plan =
      plan_round({imported("s1", std::chrono::seconds(0), "UTC as recorded, .NET ticks"),
                  imported("s2", std::chrono::seconds(8), "UTC as recorded, .NET ticks")});
  ASSERT_TRUE(plan.round) << "s2 came eight seconds later, and says so";
  EXPECT_EQ(plan.round->origin, kStart);
  EXPECT_GE(plan.round->period, std::chrono::seconds(18));
}

TEST(ReplayRound, SeparateImportsWithoutUtcAreSaidToBeOutOfStep) {
  const auto plan =
      plan_round({imported("s1", std::chrono::seconds(0), "UTC as recorded, .NET ticks"),
                  imported("s2", std::chrono::seconds(1), "the file counts from its start")});
  EXPECT_FALSE(plan.round);
  EXPECT_THAT(plan.note, HasSubstr("the clocks of s2"));
}

TEST(ReplayRound, RecordingsOfDifferentTimesHaveNoneInCommon) {
  const auto plan = plan_round({stay("s1", std::chrono::seconds(0), std::chrono::seconds(10)),
                                stay("s2", std::chrono::hours(24), std::chrono::seconds(10))});
  EXPECT_FALSE(plan.round) << "nobody wants to wait a day for s2";
  EXPECT_THAT(plan.note, HasSubstr("different times"));
}

}  // namespace
}  // namespace chorus::ctl
