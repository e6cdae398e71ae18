#include "services/ctl/replay_round.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::ctl {
namespace {

using chorus::testing::kStart;
using std::chrono::seconds;

record::FrameRecording stream(const char* sensor, Duration begin, Duration length) {
  record::FrameRecording recording;
  recording.sensor = chorus::testing::sensor_id(sensor);
  for (const Duration at : {begin, begin + length}) {
    SensorFrame frame;
    frame.captured = kStart + at;
    recording.frames.push_back(frame);
  }
  return recording;
}

TEST(ReplayRound, RecordingsMadeByTheSensorsThemselvesShareTheirBeginning) {
  record::Session session;  // of one sensor each: no cell
  session.sensors = {stream("s1", seconds(3), seconds(10)), stream("s2", seconds(0), seconds(8))};
  const auto round = round_of(session);
  ASSERT_TRUE(round);
  EXPECT_EQ(round->origin, kStart) << "s1 begins three seconds after s2, in the replay too";
  EXPECT_GT(round->period, seconds(13));
  EXPECT_LT(round->period, seconds(13) + std::chrono::milliseconds(100));
  EXPECT_FALSE(of_different_times(session));
}

TEST(ReplayRound, ACellSharesItsBeginningEvenWhenOneSensorIsLeft) {
  record::Session session;
  session.sensors = {stream("s1", seconds(3), seconds(10)), stream("s2", seconds(0), seconds(1))};
  session.cell = {session.sensors[0].sensor, session.sensors[1].sensor};
  ASSERT_TRUE(round_of(session));
  EXPECT_EQ(round_of(session)->origin, kStart);
  EXPECT_FALSE(of_different_times(session)) << "a sensor may have left before another came";
  session.sensors.pop_back();
  EXPECT_TRUE(round_of(session));
}

TEST(ReplayRound, OneStreamAloneAndSetsThatSayItThemselvesNeedNone) {
  record::Session session;
  EXPECT_FALSE(round_of(session));
  session.sensors = {stream("s1", seconds(3), seconds(10))};
  EXPECT_FALSE(round_of(session));
  session.sensors.push_back(stream("s2", seconds(0), seconds(8)));
  session.sensors[0].notes["set_origin"] = to_iso8601(kStart);
  EXPECT_TRUE(round_of(session)) << "one of them does not say it";
  session.sensors[1].notes["set_origin_ns"] = "1";
  EXPECT_FALSE(round_of(session));
}

TEST(ReplayRound, RecordingsOfDifferentTimesHaveNoneInCommon) {
  record::Session session;
  session.sensors = {stream("s1", seconds(0), seconds(10)),
                     stream("s2", std::chrono::hours(24), seconds(10))};
  EXPECT_FALSE(round_of(session)) << "nobody wants to wait a day for s2";
  EXPECT_TRUE(of_different_times(session));
}

}  // namespace
}  // namespace chorus::ctl
