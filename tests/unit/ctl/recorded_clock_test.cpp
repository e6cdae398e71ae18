// The clock of a sensor as `chorus record` keeps it: the estimate from the host's own answers.
#include "services/ctl/record/recorded_clock.h"

#include <gtest/gtest.h>

namespace chorus::ctl {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

nlohmann::json sensor(const char* text) { return nlohmann::json::parse(text); }

TEST(RecordedClock, IsWhatTheHostsAnswersTold) {
  const auto clock = clock_of(sensor(R"({"clockOffsetMilliseconds": 12.5,
      "clockUncertaintyMilliseconds": 0.25, "clockCorrected": true})"));
  EXPECT_EQ(clock.applied, microseconds(12500));
  EXPECT_EQ(clock.uncertainty, microseconds(250));
}

TEST(RecordedClock, LeavesOutAWalkAndItsUncertainty) {
  const auto clock = clock_of(sensor(R"({"clockOffsetMilliseconds": 32.5,
      "clockFromWalkMilliseconds": 20, "clockUncertaintyMilliseconds": 8,
      "clockUncertaintyWithoutWalkMilliseconds": 40, "clockCorrected": true})"));
  EXPECT_EQ(clock.applied, microseconds(12500));
  EXPECT_EQ(clock.uncertainty, milliseconds(40)) << "8 ms is what the walk says";
}

TEST(RecordedClock, IsUnknownWhereOnlyAWalkToldOfIt) {
  const auto clock = clock_of(sensor(R"({"clockOffsetMilliseconds": 200,
      "clockFromWalkMilliseconds": 200, "clockUncertaintyMilliseconds": 8,
      "clockCorrected": true})"));
  EXPECT_EQ(clock.applied, Duration{0});
  EXPECT_FALSE(clock.uncertainty);
}

}  // namespace
}  // namespace chorus::ctl
