#include "fusion-server/align/history.h"

#include <gtest/gtest.h>

namespace chorus::align {
namespace {

using std::chrono::milliseconds;

constexpr Timestamp kHistoryStart = from_unix_ns(1'790'000'000'000'000'000);

SensorFrame frame_at(Duration after) {
  SensorFrame frame;
  frame.captured = kHistoryStart + after;
  frame.received = frame.captured + milliseconds(5);
  return frame;
}

SensorFrame numbered(std::uint64_t sequence, Duration after) {
  SensorFrame frame = frame_at(after);
  frame.sequence = sequence;
  return frame;
}

TEST(HistoryPush, KeepsFramesInCaptureOrder) {
  History history;
  EXPECT_EQ(history.push(frame_at(milliseconds(0))), PushVerdict::Added);
  EXPECT_EQ(history.push(frame_at(milliseconds(33))), PushVerdict::Added);
  ASSERT_EQ(history.frames().size(), 2u);
  EXPECT_EQ(history.newest(), kHistoryStart + milliseconds(33));
}

TEST(HistoryPush, AnEmptyHistoryHasNoNewest) { EXPECT_FALSE(History().newest().has_value()); }

TEST(HistoryPush, TheSameCaptureTimeIsTakenOnce) {
  History history;
  history.push(frame_at(milliseconds(0)));
  history.push(frame_at(milliseconds(33)));
  EXPECT_EQ(history.push(frame_at(milliseconds(33))), PushVerdict::Duplicate);
  // A cache may send an older frame again.
  EXPECT_EQ(history.push(frame_at(milliseconds(0))), PushVerdict::Duplicate);
  EXPECT_EQ(history.frames().size(), 2u);
}

TEST(HistoryPush, AShortStepBackIsRefused) {
  History history;
  history.push(frame_at(milliseconds(100)));
  EXPECT_EQ(history.push(frame_at(milliseconds(90))), PushVerdict::Backwards);
  EXPECT_EQ(history.frames().size(), 1u);
}

TEST(HistoryPush, AClockThatWasSetBackIsBelievedAtTheThirdFrame) {
  for (const Duration back : {Duration(milliseconds(100)), Duration(std::chrono::seconds(2))}) {
    History history;
    history.push(numbered(1, std::chrono::seconds(10)));
    EXPECT_EQ(history.push(numbered(2, std::chrono::seconds(10) - back)), PushVerdict::Backwards);
    EXPECT_EQ(history.push(numbered(3, std::chrono::seconds(10) - back + milliseconds(33))),
              PushVerdict::Backwards);
    EXPECT_EQ(history.push(numbered(4, std::chrono::seconds(10) - back + milliseconds(66))),
              PushVerdict::Restarted);
    ASSERT_EQ(history.frames().size(), 1u);
    EXPECT_EQ(history.newest(), kHistoryStart + std::chrono::seconds(10) - back + milliseconds(66));
    EXPECT_EQ(history.push(numbered(5, std::chrono::seconds(10) - back + milliseconds(99))),
              PushVerdict::Added);
  }
}

/// A device that restarts numbers its frames from the beginning.
TEST(HistoryPush, ADeviceThatRestartsWithAnotherClockIsBelievedAtTheThirdFrame) {
  History history;
  history.push(numbered(100, std::chrono::seconds(10)));
  EXPECT_EQ(history.push(numbered(1, std::chrono::seconds(2))), PushVerdict::Stale);
  EXPECT_EQ(history.push(numbered(2, std::chrono::seconds(2) + milliseconds(33))),
            PushVerdict::Stale);
  EXPECT_EQ(history.push(numbered(3, std::chrono::seconds(2) + milliseconds(66))),
            PushVerdict::Restarted);
}

TEST(HistoryPush, OneFrameFromTheNearFutureCostsTwoFramesAndNotTheTimeUntilThen) {
  History history;
  history.push(numbered(1, std::chrono::seconds(1)));
  EXPECT_EQ(history.push(numbered(2, milliseconds(2500))), PushVerdict::Added);
  EXPECT_EQ(history.push(numbered(3, milliseconds(1066))), PushVerdict::Backwards);
  EXPECT_EQ(history.push(numbered(4, milliseconds(1100))), PushVerdict::Backwards);
  EXPECT_EQ(history.push(numbered(5, milliseconds(1133))), PushVerdict::Restarted);
  EXPECT_EQ(history.push(numbered(6, milliseconds(1166))), PushVerdict::Added);
}

TEST(HistoryPush, FramesThatOvertakeEachOtherAreAllKeptInOrder) {
  History history;
  history.push(numbered(1, milliseconds(33)));
  history.push(numbered(4, milliseconds(133)));
  EXPECT_EQ(history.push(numbered(2, milliseconds(66))), PushVerdict::Late);
  EXPECT_EQ(history.push(numbered(3, milliseconds(100))), PushVerdict::Late);
  EXPECT_EQ(history.push(numbered(3, milliseconds(100))), PushVerdict::Duplicate);
  ASSERT_EQ(history.frames().size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(history.frames()[i].sequence, i + 1);
}

/// A connection that was held up delivers its queue at once.
TEST(HistoryPush, ABurstOfOldFramesIsNoClockThatWasSetBack) {
  History history;
  history.push(numbered(50, std::chrono::seconds(3)));
  for (std::uint64_t i = 0; i < 20; ++i) {
    SensorFrame old = numbered(1 + i, milliseconds(500 + 33 * static_cast<int>(i)));
    old.received = kHistoryStart + std::chrono::seconds(4);
    EXPECT_EQ(history.push(old), PushVerdict::Stale);
  }
  EXPECT_EQ(history.newest(), kHistoryStart + std::chrono::seconds(3));
}

TEST(HistoryPush, WhatComesFarTooLateIsRefusedAndLosesNothing) {
  History history;
  history.push(numbered(1, std::chrono::seconds(1)));
  history.push(numbered(50, std::chrono::seconds(3)));
  EXPECT_EQ(history.push(numbered(2, milliseconds(1400))), PushVerdict::Stale);
  EXPECT_EQ(history.frames().size(), 2u);
}

TEST(History, MovesInTimeAsAWhole) {
  History history;
  for (int i = 0; i < 20; ++i) history.push(frame_at(milliseconds(33 * i)));
  history.move_in_time(milliseconds(200));
  EXPECT_EQ(history.newest(), kHistoryStart + milliseconds(33 * 19 + 200));
  EXPECT_EQ(history.habit()->least_delay, milliseconds(5 - 200));
}

TEST(HistoryPush, AFrameFromTheFutureIsRefused) {
  History history;
  SensorFrame frame = frame_at(std::chrono::seconds(60));
  frame.received = kHistoryStart;
  EXPECT_EQ(history.push(frame), PushVerdict::Future);
  EXPECT_TRUE(history.frames().empty());
}

TEST(HistoryPush, WithoutAReceiveTimeNothingIsCalledFuture) {
  History history;
  SensorFrame frame = frame_at(std::chrono::seconds(60));
  frame.received = Timestamp{};
  EXPECT_EQ(history.push(frame), PushVerdict::Added);
}

TEST(HistoryPush, ForgetsByCountAndByAge) {
  History few({.max_frames = 3});
  for (int i = 0; i < 10; ++i) few.push(frame_at(milliseconds(33 * i)));
  EXPECT_EQ(few.frames().size(), 3u);
  History young({.max_age = milliseconds(100)});
  for (int i = 0; i < 10; ++i) young.push(frame_at(milliseconds(30 * i)));
  EXPECT_EQ(young.frames().front().captured, kHistoryStart + milliseconds(180));
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
