#include "fusion-server/align/history.h"

#include <gtest/gtest.h>

namespace chorus::align {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Timestamp kStart = from_unix_ns(1'790'000'000'000'000'000);

SensorFrame frame_at(Duration after) {
  SensorFrame frame;
  frame.captured = kStart + after;
  frame.received = frame.captured + milliseconds(5);
  return frame;
}

TEST(HistoryPush, KeepsFramesInCaptureOrder) {
  History history;
  EXPECT_EQ(history.push(frame_at(milliseconds(0))), PushVerdict::Added);
  EXPECT_EQ(history.push(frame_at(milliseconds(33))), PushVerdict::Added);
  ASSERT_EQ(history.frames().size(), 2u);
  EXPECT_EQ(history.newest(), kStart + milliseconds(33));
}

TEST(HistoryPush, AnEmptyHistoryHasNoNewest) { EXPECT_FALSE(History().newest().has_value()); }

TEST(HistoryPush, TheSameCaptureTimeIsTakenOnce) {
  History history;
  history.push(frame_at(milliseconds(0)));
  history.push(frame_at(milliseconds(33)));
  EXPECT_EQ(history.push(frame_at(milliseconds(33))), PushVerdict::Duplicate);
  // As a cache would do.
  EXPECT_EQ(history.push(frame_at(milliseconds(0))), PushVerdict::Duplicate);
  EXPECT_EQ(history.frames().size(), 2u);
}

TEST(HistoryPush, AShortStepBackIsRefused) {
  History history;
  history.push(frame_at(milliseconds(100)));
  EXPECT_EQ(history.push(frame_at(milliseconds(90))), PushVerdict::Backwards);
  EXPECT_EQ(history.frames().size(), 1u);
}

TEST(HistoryPush, ALongStepBackStartsAnew) {
  History history;
  history.push(frame_at(seconds(10)));
  EXPECT_EQ(history.push(frame_at(seconds(8))), PushVerdict::Restarted);
  ASSERT_EQ(history.frames().size(), 1u);
  EXPECT_EQ(history.newest(), kStart + seconds(8));
}

TEST(HistoryPush, AFrameFromTheFutureIsRefused) {
  History history;
  SensorFrame frame = frame_at(seconds(60));
  frame.received = kStart;
  EXPECT_EQ(history.push(frame), PushVerdict::Future);
  EXPECT_TRUE(history.frames().empty());
}

TEST(HistoryPush, WithoutAReceiveTimeNothingIsCalledFuture) {
  History history;
  SensorFrame frame = frame_at(seconds(60));
  frame.received = Timestamp{};
  EXPECT_EQ(history.push(frame), PushVerdict::Added);
}

TEST(HistoryPush, ForgetsByCountAndByAge) {
  History few({.max_frames = 3});
  for (int i = 0; i < 10; ++i) few.push(frame_at(milliseconds(33 * i)));
  EXPECT_EQ(few.frames().size(), 3u);
  History young({.max_age = milliseconds(100)});
  for (int i = 0; i < 10; ++i) young.push(frame_at(milliseconds(30 * i)));
  EXPECT_EQ(young.frames().front().captured, kStart + milliseconds(180));
}

TEST(HistoryPush, OfTwoBodiesWithOneIdTheFirstIsKept) {
  SensorFrame frame = frame_at(milliseconds(0));
  frame.bodies.resize(3);
  frame.bodies[0].id = frame.bodies[1].id = BodyId{7};
  frame.bodies[2].id = BodyId{8};
  frame.bodies[0].skeleton[JointId::Neck].position.x() = 1.0;
  History history;
  EXPECT_EQ(history.push(frame), PushVerdict::Added);
  const auto& bodies = history.frames().front().bodies;
  ASSERT_EQ(bodies.size(), 2u);
  EXPECT_DOUBLE_EQ(bodies[0].skeleton[JointId::Neck].position.x(), 1.0);
  EXPECT_EQ(bodies[1].id, BodyId{8});
}

}  // namespace
}  // namespace chorus::align
