// Following by event stream, without a socket and without sleeping.
#include "common/client/poll_fsm.h"

#include <gtest/gtest.h>

#include "tests/unit/client/poll_rig.h"

namespace chorus::client {
namespace {

using std::chrono::milliseconds;

StreamFrame streamed(std::uint64_t sequence, int ms, bool odd = false) {
  return {sequence, at_ms(ms), odd};
}

/// A follower that has used a stream since `now`; it has no request under way and sleeps until its
/// next request for the clock is due.
PollFsm streaming(Duration now) {
  PollFsm fsm = live(now);
  (void)fsm.resume(streamed(2, 33), now, kFull);
  (void)fsm.resume(FrameAnswered{304, "\"1\""}, now + milliseconds(1), kFull);
  return fsm;
}

TEST(PollFsmStream, OnceFramesComeAStreamIsOpenedBesideThePolling) {
  PollFsm fsm = at_first_frame(milliseconds(0));
  const Step step = fsm.resume(frame(0, "\"1\""), milliseconds(20), kFull);
  EXPECT_EQ(step.stream, StreamOrder::Open);
  EXPECT_EQ(send_of(step).resource, Resource::Frame);
  EXPECT_FALSE(fsm.streaming());
  EXPECT_EQ(fsm.resume(frame(1, "\"2\""), milliseconds(50), kFull).stream, StreamOrder::None);
}

TEST(PollFsmStream, NotWhenItIsSwitchedOff) {
  PollTimings timings;
  timings.stream = false;
  PollFsm fsm(timings);
  (void)fsm.resume(Started{}, milliseconds(0), kFull);
  (void)fsm.resume(FloorAnswered{}, milliseconds(0), kFull);
  EXPECT_EQ(fsm.resume(frame(0, "\"1\""), milliseconds(20), kFull).stream, StreamOrder::None);
}

TEST(PollFsmStream, ItsFramesAreDeliveredAndTheRequestsOnlyKeepTheClock) {
  PollFsm fsm = live(milliseconds(0));
  const Step first = fsm.resume(streamed(2, 33), milliseconds(33), kFull);
  EXPECT_TRUE(first.deliver);
  EXPECT_FALSE(first.action);  // the long poll is still under way
  EXPECT_TRUE(fsm.streaming());
  const Step old = fsm.resume(frame(33, "\"2\""), milliseconds(34), kFull);
  EXPECT_FALSE(old.deliver);
  const Step clock = fsm.resume(Woke{}, milliseconds(34) + sleep_of(old), kFull);
  EXPECT_EQ(send_of(clock).resource, Resource::Clock);
  const Step hurry =
      // The clock is not accurate yet.
      fsm.resume(ClockAnswered{milliseconds(5)}, milliseconds(140), kFull);
  EXPECT_LE(sleep_of(hurry), milliseconds(100));
  (void)fsm.resume(streamed(3, 66), milliseconds(141), kFull);
  (void)fsm.resume(Woke{}, milliseconds(240), kFull);
  (void)fsm.resume(ClockAnswered{std::chrono::microseconds(100)}, milliseconds(241), kFull);
  const Step calm = fsm.resume(Woke{}, milliseconds(245), kFull);
  EXPECT_GT(sleep_of(calm), milliseconds(400));
}

/// A stream of 30 Hz whose clock is asked for again and again.
class Hurried {
 public:
  Hurried() { (void)fsm_.resume(Woke{}, now_, kFull); }

  /// How long the follower waits after each of `count` answers that leave the offset so uncertain.
  std::vector<Duration> pauses(int count, const ClockAnswered& answer) {
    std::vector<Duration> all;
    for (int i = 0; i < count; ++i) {
      now_ += milliseconds(1);
      const Duration since = now_;
      Step step = fsm_.resume(answer, now_, kFull);
      while (std::holds_alternative<Sleep>(*step.action)) step = wake(now_ + sleep_of(step));
      EXPECT_EQ(send_of(step).resource, Resource::Clock);
      all.push_back(now_ - since);
    }
    return all;
  }

 private:
  Step wake(Duration at) {
    for (; now_ + kFrame < at; ++sequence_) {
      now_ += kFrame;
      (void)fsm_.resume(streamed(sequence_, static_cast<int>(now_ / milliseconds(1))), now_, kFull);
    }
    now_ = at;
    return fsm_.resume(Woke{}, now_, kFull);
  }

  static constexpr Duration kFrame = milliseconds(33);
  PollFsm fsm_ = streaming(milliseconds(0));
  Duration now_ = milliseconds(150);
  std::uint64_t sequence_ = 3;
};

TEST(PollFsmStream, AClockThatDoesNotBecomeBetterKnownIsAskedInAHurryForAWhileOnly) {
  Hurried hurried;
  const auto pauses = hurried.pauses(55, {milliseconds(5)});
  EXPECT_LE(pauses[1], milliseconds(110));
  EXPECT_LE(pauses[48], milliseconds(110));
  EXPECT_GE(pauses.back(), milliseconds(400));
  (void)hurried.pauses(1, {milliseconds(5), true});
  EXPECT_LE(hurried.pauses(1, {milliseconds(5)}).back(), milliseconds(110))
      << "a clock that was set is new";
}

TEST(PollFsmStream, AFrameTwiceIsNoNews) {
  PollFsm fsm = streaming(milliseconds(0));
  EXPECT_FALSE(fsm.resume(streamed(2, 33), milliseconds(5), kFull).deliver);
  EXPECT_TRUE(fsm.resume(streamed(3, 66), milliseconds(40), kFull).deliver);
}

TEST(PollFsmStream, WhatItLeavesOutIsFetchedAtOnceOneByOne) {
  PollFsm fsm = streaming(milliseconds(0));
  const Step gap = fsm.resume(streamed(5, 132), milliseconds(100), kFull);
  EXPECT_EQ(send_of(gap).resource, Resource::KeptFrame);
  EXPECT_EQ(send_of(gap).sequence, 3u);
  // There is no second request while one is in flight.
  EXPECT_FALSE(fsm.resume(streamed(6, 165), milliseconds(133), kFull).action);
  const Step next = fsm.resume(KeptAnswered{true}, milliseconds(201), kFull);
  EXPECT_TRUE(next.deliver);
  EXPECT_EQ(send_of(next).sequence, 4u);
  EXPECT_FALSE(fsm.resume(KeptAnswered{false}, milliseconds(300), kFull).deliver);
}

TEST(PollFsmStream, OneThatEndsLeavesThePolling) {
  PollFsm fsm = streaming(milliseconds(0));
  const Step ended =
      fsm.resume(StreamEnded{{ErrorCode::Unavailable, "x", "broke off"}}, milliseconds(50), kFull);
  EXPECT_EQ(send_of(ended).resource, Resource::Frame);
  EXPECT_EQ(fsm.state(), SensorState::Live);  // polling will decide
  EXPECT_FALSE(fsm.streaming());
  // The next stream is opened only after a second.
  EXPECT_EQ(fsm.resume(frame(99, "\"3\""), milliseconds(80), kFull).stream, StreamOrder::None);
  EXPECT_EQ(fsm.resume(frame(1200, "\"4\""), milliseconds(1200), kFull).stream, StreamOrder::Open);
}

TEST(PollFsmStream, WhoHasNoneIsAskedAgainAfterAMinute) {
  PollFsm fsm = live(milliseconds(0));
  (void)fsm.resume(StreamEnded{{ErrorCode::Unsupported, "x", "no stream"}}, milliseconds(5), kFull);
  int ms = 33;
  while (fsm.resume(frame(ms, "\"" + std::to_string(ms) + "\""), milliseconds(ms), kFull).stream ==
         StreamOrder::None)
    ms += 33;
  EXPECT_NEAR(ms, 60000, 100);
}

TEST(PollFsmStream, OneThatFallsSilentIsClosedForThePolling) {
  PollFsm fsm = streaming(milliseconds(0));
  Duration now = milliseconds(1);
  Step step{Sleep{milliseconds(99)}};
  while (step.stream == StreamOrder::None && now < std::chrono::seconds(10)) {
    if (std::holds_alternative<Sleep>(*step.action)) {
      now += sleep_of(step);
      step = fsm.resume(Woke{}, now, kFull);
    } else {
      step = fsm.resume(ClockAnswered{milliseconds(1)}, now += milliseconds(1), kFull);
    }
  }
  EXPECT_EQ(step.stream, StreamOrder::Close);
  EXPECT_EQ(send_of(step).resource, Resource::Frame);
  EXPECT_GT(now, PollTimings{}.wait);
  EXPECT_LT(now, PollTimings{}.wait + milliseconds(600));
}

TEST(PollFsmStream, ARequestThatFailsBesideItCostsTheSensorNothing) {
  PollFsm fsm = streaming(milliseconds(0));
  (void)fsm.resume(Woke{}, milliseconds(150), kFull);
  (void)fsm.resume(streamed(3, 66), milliseconds(151), kFull);
  const Step failed = fsm.resume(reset(), milliseconds(160), kFull);
  EXPECT_EQ(fsm.state(), SensorState::Live);
  EXPECT_EQ(failed.stream, StreamOrder::None);
  EXPECT_TRUE(fsm.streaming());
  // But when the stream falls silent, the sensor counts as lost and the stream is closed.
  (void)fsm.resume(Woke{}, milliseconds(700), kFull);
  const Step lost = fsm.resume(reset(), milliseconds(1700), kFull);
  EXPECT_EQ(fsm.state(), SensorState::Lost);
  EXPECT_EQ(lost.stream, StreamOrder::Close);
  // Once the sensor is back, the server opens a stream at once.
  EXPECT_EQ(fsm.resume(frame(1750, "\"9\""), milliseconds(1750), kFull).stream, StreamOrder::Open);
}

TEST(PollFsmStream, AnOddFrameMakesTheClockUrgent) {
  PollFsm fsm = streaming(milliseconds(0));
  const Step odd = fsm.resume(streamed(3, 900, true), milliseconds(40), kFull);
  EXPECT_EQ(send_of(odd).resource, Resource::Clock);
  EXPECT_TRUE(fsm.checking_clock());
  Duration now = milliseconds(40);
  int checks = 1;
  Step step = fsm.resume(ClockAnswered{milliseconds(1), true}, now += milliseconds(5), kFull);
  for (; fsm.checking_clock(); ++checks) {
    ASSERT_EQ(send_of(step).resource, Resource::Clock);
    step = fsm.resume(ClockAnswered{milliseconds(1), true}, now += milliseconds(5), kFull);
  }
  EXPECT_GE(checks, 3);  // as many as the filter needs before it accepts a step
  EXPECT_LT(now, milliseconds(100));
  // A sensor whose frames are all odd does not cause permanent clock requests.
  (void)fsm.resume(ClockAnswered{milliseconds(1)}, now, kFull);
  (void)fsm.resume(streamed(4, 950, true), now + milliseconds(10), kFull);
  EXPECT_FALSE(fsm.checking_clock());
}

TEST(PollFsmStream, ASensorThatTellsNoTimeIsHardlyAskedForIt) {
  PollFsm fsm = streaming(milliseconds(0));
  (void)fsm.resume(Woke{}, milliseconds(150), kFull);
  Step step = fsm.resume(ClockAnswered{}, milliseconds(151), kFull);
  int asked = 0;
  for (Duration now = milliseconds(151); now < std::chrono::seconds(5); now += milliseconds(33)) {
    (void)fsm.resume(streamed(3 + static_cast<std::uint64_t>(now.count()),
                              static_cast<int>(now / milliseconds(1))),
                     now, kFull);
    step = fsm.resume(Woke{}, now, kFull);
    asked += std::holds_alternative<Send>(*step.action) ? 1 : 0;
  }
  EXPECT_EQ(asked, 0);
}

/// A follower of a stream at 30 Hz in which one frame came 0.3 s late; the follower sleeps, and
/// its newest frame came at `now`.
PollFsm late_once(Duration now) {
  PollFsm fsm = streaming(now - milliseconds(600));
  for (int i = 3; i <= 10; ++i)
    (void)fsm.resume(streamed(i, 33 * (i - 1)), now - milliseconds(600 - 33 * (i - 2)), kFull);
  (void)fsm.resume(streamed(11, 330), now, kFull);
  (void)fsm.resume(Woke{}, now, kFull);
  (void)fsm.resume(ClockAnswered{std::chrono::microseconds(100)}, now, kFull);
  (void)fsm.resume(Woke{}, now + milliseconds(4), kFull);
  return fsm;
}

TEST(PollFsmStream, TheNewestFrameIsAskedForBesideAStreamThatIsHeldUp) {
  PollFsm fsm = late_once(std::chrono::seconds(1));
  EXPECT_FALSE(fsm.asking());
  const Step asked = fsm.resume(Woke{}, std::chrono::seconds(1) + milliseconds(80), kFull);
  EXPECT_EQ(send_of(asked).resource, Resource::Frame);
  const Step newest =
      fsm.resume(frame(396, "\"13\""), std::chrono::seconds(1) + milliseconds(95), kFull);
  EXPECT_TRUE(newest.deliver);
  EXPECT_FALSE(newest.late);
  EXPECT_EQ(send_of(newest).etag, "\"13\"") << "and the one after it";
}

TEST(PollFsmStream, AServerThatIgnoresPreferIsNotAskedInCirclesBesideTheStream) {
  PollFsm fsm = late_once(std::chrono::seconds(1));
  (void)fsm.resume(Woke{}, std::chrono::seconds(1) + milliseconds(80), kFull);
  const Step same =
      fsm.resume(frame(330, "\"11\""), std::chrono::seconds(1) + milliseconds(81), kFull);
  EXPECT_FALSE(same.deliver);
  EXPECT_EQ(sleep_of(same), milliseconds(9)) << "the idle interval, from the request on";
  const Step dead = fsm.resume(Woke{}, std::chrono::seconds(4), kFull);
  EXPECT_EQ(dead.stream, StreamOrder::Close) << "a stream this silent is given up";
}

TEST(PollFsmStream, WhatTheStreamBringsAfterItIsLateAndNothingComesTwice) {
  PollFsm fsm = late_once(std::chrono::seconds(1));
  (void)fsm.resume(Woke{}, std::chrono::seconds(1) + milliseconds(80), kFull);
  (void)fsm.resume(frame(396, "\"13\""), std::chrono::seconds(1) + milliseconds(95), kFull);
  const Step before =
      fsm.resume(streamed(12, 363), std::chrono::seconds(1) + milliseconds(200), kFull);
  EXPECT_TRUE(before.deliver);
  EXPECT_TRUE(before.late);
  EXPECT_FALSE(
      fsm.resume(streamed(13, 396), std::chrono::seconds(1) + milliseconds(200), kFull).deliver);
  const Step after =
      fsm.resume(streamed(14, 429), std::chrono::seconds(1) + milliseconds(201), kFull);
  EXPECT_TRUE(after.deliver);
  EXPECT_FALSE(after.late);
  EXPECT_FALSE(
      fsm.resume(frame(429, "\"14\""), std::chrono::seconds(1) + milliseconds(202), kFull).deliver);
}

TEST(PollFsmStream, NobodyIsAskedBesideAStreamThatIsNeverHeldUp) {
  PollFsm fsm = streaming(milliseconds(0));
  Duration now{0};
  for (int i = 3; i < 300; ++i) {
    now += milliseconds(33);
    (void)fsm.resume(streamed(i, 33 * (i - 1)), now, kFull);
    const Step step = fsm.resume(Woke{}, now + milliseconds(20), kFull);
    if (const auto* send = std::get_if<Send>(&*step.action)) {
      EXPECT_NE(send->resource, Resource::Frame);
      (void)fsm.resume(ClockAnswered{std::chrono::microseconds(100)}, now + milliseconds(21),
                       kFull);
    }
  }
}

}  // namespace
}  // namespace chorus::client
