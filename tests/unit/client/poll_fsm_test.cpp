// The polling loop, without a socket and without sleeping.
#include "common/client/poll_fsm.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/client/poll_rig.h"

namespace chorus::client {
namespace {

using std::chrono::milliseconds;

constexpr double kHalf = 0.0;

TEST(PollFsm, AsksForTheFloorFirstAndThenForAFrameWithoutCondition) {
  PollFsm fsm;
  const Step first = fsm.resume(Started{}, milliseconds(0), kFull);
  EXPECT_EQ(send_of(first).resource, Resource::FloorPlane);
  EXPECT_GT(send_of(first).deadline, Duration{0});
  const Step second = fsm.resume(FloorAnswered{}, milliseconds(1), kFull);
  EXPECT_EQ(send_of(second).resource, Resource::Frame);
  EXPECT_EQ(send_of(second).etag, "");
  EXPECT_EQ(send_of(second).wait, Duration{0});
  EXPECT_EQ(fsm.state(), SensorState::Connecting);
}

TEST(PollFsm, ANewFrameIsDeliveredAndTheNextOneIsLongPolledAtOnce) {
  PollFsm fsm = at_first_frame(milliseconds(0));
  const Step step = fsm.resume(frame(0, "\"7-ttl\""), milliseconds(30), kFull);
  EXPECT_TRUE(step.deliver);
  EXPECT_EQ(send_of(step).etag, "\"7-ttl\"");
  EXPECT_EQ(send_of(step).wait, PollTimings{}.wait);
  EXPECT_EQ(send_of(step).deadline, PollTimings{}.wait + PollTimings{}.answer_slack);
  EXPECT_EQ(fsm.state(), SensorState::Live);
  ASSERT_TRUE(step.notice);
  EXPECT_EQ(step.notice->event, "sensor live");
  EXPECT_FALSE(step.notice->warning);
}

TEST(PollFsm, FramesFasterThanTheMinimumIntervalAreSlowedDown) {
  PollFsm fsm = live(milliseconds(1000));
  const Step step = fsm.resume(frame(1, "\"2\""), milliseconds(1001), kFull);
  EXPECT_TRUE(step.deliver);
  EXPECT_EQ(sleep_of(step), milliseconds(3));
  EXPECT_EQ(send_of(fsm.resume(Woke{}, milliseconds(1004), kFull)).etag, "\"2\"");
}

TEST(PollFsm, AServerThatIgnoresPreferIsAskedAtTheIdleInterval) {
  PollFsm fsm = live(milliseconds(1000));
  const Step step = fsm.resume(FrameAnswered{304, "\"1\""}, milliseconds(1001), kFull);
  EXPECT_FALSE(step.deliver);
  EXPECT_EQ(sleep_of(step), milliseconds(9));
  EXPECT_EQ(fsm.state(), SensorState::Live);
}

TEST(PollFsm, AServerWithoutEtagNeverSpinsAndRepeatsAreNotDelivered) {
  PollFsm fsm = at_first_frame(milliseconds(0));
  EXPECT_TRUE(fsm.resume(frame(0, ""), milliseconds(5), kFull).deliver);
  const Step again = fsm.resume(frame(0, ""), milliseconds(6), kFull);
  EXPECT_FALSE(again.deliver);
  EXPECT_EQ(sleep_of(again), milliseconds(9));
  const Step next = fsm.resume(Woke{}, milliseconds(15), kFull);
  EXPECT_EQ(send_of(next).etag, "");
  EXPECT_EQ(send_of(next).wait, Duration{0});
}

TEST(PollFsm, A304AfterTheWholeWaitMeansTheDeviceIsSilent) {
  PollFsm fsm = live(milliseconds(1000));
  const Step step = fsm.resume(FrameAnswered{304, "\"1\""}, milliseconds(3001), kFull);
  EXPECT_EQ(send_of(step).etag, "\"1\"");
  EXPECT_EQ(fsm.state(), SensorState::Lost);
  ASSERT_TRUE(step.notice);
  EXPECT_EQ(step.notice->event, "sensor lost");
  EXPECT_EQ(step.notice->reason, "the sensor service answers, but has no new frame");
}

TEST(PollFsm, TimeGoingBackwardsIsNewsForTheHistoryToJudge) {
  PollFsm fsm = live(milliseconds(1000));
  EXPECT_TRUE(fsm.resume(frame(-500, "\"2\""), milliseconds(1033), kFull).deliver);
}

TEST(PollFsm, BackOffDoublesFromATenthOfASecondToOneSecond) {
  PollFsm fsm = live(milliseconds(0));
  const int expected_ms[] = {100, 200, 400, 800, 1000, 1000, 1000, 1000, 1000};
  Duration now{0};
  for (const int ms : expected_ms) {
    const Step step = fsm.resume(reset(), now, kFull);
    EXPECT_NEAR(chorus::seconds(sleep_of(step)), ms / 1000.0, 1e-6);
    now += sleep_of(step);
    (void)fsm.resume(Woke{}, now, kFull);
  }
  EXPECT_EQ(fsm.failures(), 9u);
}

TEST(PollFsm, JitterHalvesAtMostAndNonsenseJitterIsZero) {
  for (const double jitter : {kHalf, -3.0, 7.0, std::numeric_limits<double>::quiet_NaN()}) {
    PollFsm fsm = live(milliseconds(0));
    EXPECT_EQ(sleep_of(fsm.resume(reset(), milliseconds(1), jitter)), milliseconds(50)) << jitter;
  }
}

TEST(PollFsm, AGoodAnswerResetsTheBackOff) {
  PollFsm fsm = live(milliseconds(0));
  for (int i = 0; i < 6; ++i) (void)fsm.resume(reset(), milliseconds(i), kFull);
  (void)fsm.resume(Woke{}, milliseconds(10), kFull);
  EXPECT_TRUE(fsm.resume(frame(99, "\"9\""), milliseconds(40), kFull).deliver);
  EXPECT_EQ(sleep_of(fsm.resume(reset(), milliseconds(50), kHalf)), milliseconds(50));
}

TEST(PollFsm, AFailureNeverFollowsWithoutAPauseHoweverManyThereAre) {
  PollFsm fsm;
  (void)fsm.resume(Started{}, milliseconds(0), kHalf);
  for (int i = 0; i < 1000; ++i) {
    const Step step = fsm.resume(reset(), milliseconds(i), kHalf);
    EXPECT_GE(sleep_of(step), milliseconds(50));
    EXPECT_LE(sleep_of(step), std::chrono::seconds(1));
  }
}

TEST(PollFsm, AnUnreachableSensorIsConnectingAndALiveOneIsLost) {
  PollFsm never = at_first_frame(milliseconds(0));
  const Step first = never.resume(reset(), milliseconds(1), kFull);
  EXPECT_EQ(never.state(), SensorState::Connecting);
  ASSERT_TRUE(first.notice);
  EXPECT_EQ(first.notice->event, "sensor not reached");
  EXPECT_EQ(first.notice->reason, "127.0.0.1:8081: connection reset");

  PollFsm once = live(milliseconds(0));
  const Step lost = once.resume(reset(), std::chrono::seconds(2), kFull);
  EXPECT_EQ(once.state(), SensorState::Lost);
  ASSERT_TRUE(lost.notice);
  EXPECT_EQ(lost.notice->event, "sensor lost");
  EXPECT_TRUE(lost.notice->warning);
}

TEST(PollFsm, StatusesThatNoSensorGivesAreRefusedWithAdvice) {
  for (const int status : {301, 400, 404, 406, 500, 204, 0}) {
    PollFsm fsm = at_first_frame(milliseconds(0));
    const Step step = fsm.resume(FrameAnswered{status}, milliseconds(1), kFull);
    EXPECT_FALSE(step.deliver);
    EXPECT_EQ(fsm.state(), SensorState::Refused);
    EXPECT_EQ(fsm.last_error(), "GET frame answers " + std::to_string(status) +
                                    "; check that the url is that of a sensor service");
    EXPECT_NEAR(chorus::seconds(sleep_of(step)), 0.1, 1e-6);
  }
}

TEST(PollFsm, AWrongTokenIsRefusedWithWhereToPutTheRightOne) {
  for (const int status : {401, 403}) {
    PollFsm fsm = at_first_frame(milliseconds(0));
    (void)fsm.resume(FrameAnswered{status}, milliseconds(1), kFull);
    EXPECT_EQ(fsm.state(), SensorState::Refused);
    EXPECT_EQ(fsm.last_error(), "GET frame answers " + std::to_string(status) +
                                    "; give the sensor's entry here a token of its http.tokens");
  }
}

TEST(PollFsm, TooManyRequestsAreNotCalledAWrongToken) {
  PollFsm fsm = at_first_frame(milliseconds(0));
  (void)fsm.resume(FrameAnswered{429}, milliseconds(1), kFull);
  EXPECT_EQ(fsm.state(), SensorState::Refused);
  EXPECT_EQ(fsm.last_error().find("token"), std::string::npos) << fsm.last_error();
  EXPECT_NE(fsm.last_error().find("fewer requests"), std::string::npos) << fsm.last_error();
}

TEST(PollFsm, ARefusedTokenIsTriedAgainWithinASecond) {
  PollFsm fsm = at_first_frame(milliseconds(0));
  for (int i = 0; i < 9; ++i) {
    EXPECT_LE(sleep_of(fsm.resume(FrameAnswered{401}, milliseconds(1), kFull)),
              std::chrono::seconds(1))
        << "a sensor whose tokens were mended contributes again soon";
    (void)fsm.resume(Woke{}, milliseconds(2), kFull);
  }
}

TEST(PollFsm, TooManyRequestsDoNotHideThatTheTokenIsWrong) {
  PollFsm fsm = at_first_frame(milliseconds(0));
  (void)fsm.resume(FrameAnswered{401}, milliseconds(1), kFull);
  (void)fsm.resume(Woke{}, milliseconds(2), kFull);
  (void)fsm.resume(FrameAnswered{429}, milliseconds(3), kFull);
  EXPECT_EQ(fsm.last_error(),
            "GET frame answers 401; give the sensor's entry here a token of its http.tokens");
}

TEST(PollFsm, A503IsADeviceThatIsNotReadyYet) {
  PollFsm fsm = at_first_frame(milliseconds(0));
  (void)fsm.resume(FrameAnswered{503}, milliseconds(1), kFull);
  EXPECT_EQ(fsm.state(), SensorState::Connecting);
  EXPECT_EQ(fsm.last_error(),
            "the sensor service answers 503: its device delivers no frames; its /healthz says why");
}

TEST(PollFsm, AnUnreadableBodyIsRefusedAndItsTagForgotten) {
  PollFsm fsm = live(milliseconds(0));
  const Step step =
      fsm.resume(Unreadable{Error{ErrorCode::Malformed, "skeletons/7#Head", "x is not a number"}},
                 std::chrono::seconds(1), kFull);
  EXPECT_FALSE(step.deliver);
  EXPECT_EQ(fsm.state(), SensorState::Refused);
  EXPECT_EQ(fsm.last_error(), "skeletons/7#Head: x is not a number");
  EXPECT_EQ(send_of(fsm.resume(Woke{}, std::chrono::seconds(2), kFull)).etag, "");
  const Step good = fsm.resume(frame(5, "\"5\""), std::chrono::seconds(3), kFull);
  EXPECT_TRUE(good.deliver);
  EXPECT_EQ(fsm.state(), SensorState::Live);
}

TEST(PollFsm, AReasonIsCutThatQuotesTheWholeAnswer) {
  PollFsm fsm = live(milliseconds(0));
  const Error endless{ErrorCode::Malformed, std::string(500'000, 'x'), "is not a number"};
  const Step step = fsm.resume(Unreadable{endless}, std::chrono::seconds(5), kFull);
  EXPECT_LT(fsm.last_error().size(), 600U);
  ASSERT_TRUE(step.notice);
  EXPECT_LT(step.notice->reason.size(), 600U);
}

TEST(PollFsm, TheFloorIsAskedForAgainLaterBetweenFrames) {
  PollFsm fsm = live(milliseconds(100));
  const Step before = fsm.resume(frame(1, "\"2\""), std::chrono::seconds(9), kFull);
  EXPECT_EQ(send_of(before).resource, Resource::Frame);
  const Step due = fsm.resume(frame(2, "\"3\""), std::chrono::seconds(11), kFull);
  EXPECT_TRUE(due.deliver);
  EXPECT_EQ(send_of(due).resource, Resource::FloorPlane);
  const Step after = fsm.resume(FloorAnswered{}, std::chrono::seconds(11), kFull);
  EXPECT_EQ(send_of(after).resource, Resource::Frame);
  EXPECT_EQ(send_of(after).etag, "\"3\"");
}

TEST(PollFsm, AFloorThatNeverAnswersDoesNotKeepTheFramesAway) {
  PollFsm fsm;
  (void)fsm.resume(Started{}, milliseconds(0), kFull);
  (void)fsm.resume(reset(), std::chrono::seconds(1), kFull);
  EXPECT_EQ(send_of(fsm.resume(Woke{}, std::chrono::seconds(2), kFull)).resource, Resource::Frame);
}

TEST(PollFsm, NoticesComeOnceAndAtMostOnceASecond) {
  PollFsm fsm = live(milliseconds(0));  // "live" was logged at 0
  // The notice of the loss is still held back.
  EXPECT_FALSE(fsm.resume(reset(), milliseconds(500), kFull).notice);
  const Step later = fsm.resume(reset(), milliseconds(1200), kFull);
  ASSERT_TRUE(later.notice);
  EXPECT_EQ(later.notice->event, "sensor lost");
  EXPECT_FALSE(fsm.resume(reset(), std::chrono::seconds(10), kFull)
                   .notice);  // for the same reason as before
  const Error other{ErrorCode::Timeout, "127.0.0.1:8081", "no answer"};
  const Step changed = fsm.resume(Failed{other}, std::chrono::seconds(20), kFull);
  ASSERT_TRUE(changed.notice);
  EXPECT_EQ(changed.notice->reason, "127.0.0.1:8081: no answer");
}

TEST(PollFsm, EveryStateHasAName) {
  EXPECT_EQ(name_of(SensorState::Connecting), "connecting");
  EXPECT_EQ(name_of(SensorState::Live), "live");
  EXPECT_EQ(name_of(SensorState::Lost), "lost");
  EXPECT_EQ(name_of(SensorState::Refused), "refused");
}

TEST(PollFsm, TheFloorIsAskedForOnBecomingLiveWhenItWasAskedInVain) {
  PollFsm fsm;
  (void)fsm.resume(Started{}, milliseconds(0), kFull);
  (void)fsm.resume(reset(), milliseconds(1), kFull);  // the sensor is not there yet
  (void)fsm.resume(Woke{}, milliseconds(101), kFull);
  const Step live = fsm.resume(frame(0, "\"1\""), milliseconds(120), kFull);
  EXPECT_TRUE(live.deliver);
  EXPECT_EQ(send_of(live).resource, Resource::FloorPlane);
}

TEST(PollFsm, AFloorThatIsNotKnownYetIsAskedForAgainSoon) {
  PollFsm fsm = at_first_frame(milliseconds(0));
  (void)fsm.resume(frame(0, "\"1\""), milliseconds(20), kFull);
  (void)fsm.resume(frame(33, "\"2\""), std::chrono::seconds(11), kFull);  // the floor plane is due
  (void)fsm.resume(FloorAnswered{false}, std::chrono::seconds(11), kFull);
  EXPECT_EQ(send_of(fsm.resume(frame(66, "\"3\""), milliseconds(12100), kFull)).resource,
            Resource::FloorPlane);
}

TEST(PollFsm, ALiveSensorHasNoError) {
  PollFsm fsm = live(milliseconds(0));
  (void)fsm.resume(reset(), milliseconds(10), kFull);
  EXPECT_NE(fsm.last_error(), "");
  (void)fsm.resume(Woke{}, milliseconds(110), kFull);
  (void)fsm.resume(frame(200, "\"5\""), milliseconds(200), kFull);
  EXPECT_EQ(fsm.last_error(), "");
}

TEST(PollFsm, WhoCostsMuchReadingRests) {
  PollFsm fsm = live(milliseconds(0));
  FrameAnswered heavy = frame(33, "\"2\"");
  heavy.rest = milliseconds(300);
  const Step step = fsm.resume(heavy, milliseconds(33), kFull);
  EXPECT_TRUE(step.deliver);
  EXPECT_EQ(sleep_of(step), milliseconds(300));
  (void)fsm.resume(Woke{}, milliseconds(333), kFull);
  Unreadable junk{Error{ErrorCode::Malformed, "", "junk"}, std::chrono::seconds(3)};
  EXPECT_EQ(sleep_of(fsm.resume(junk, milliseconds(340), kFull)), std::chrono::seconds(3));
}

}  // namespace
}  // namespace chorus::client
