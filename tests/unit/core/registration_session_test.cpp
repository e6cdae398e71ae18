// A walk is collected, solved in time, and never spoils what was good.
#include "fusion-server/core/registration_session.h"

#include <gtest/gtest.h>

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const Timestamp kT0 = from_unix_ns(1'790'000'000'000'000'000);

SensorId id(const char* text) { return *SensorId::parse(text); }

SensorFrame frame(const char* sensor, Duration since, std::size_t bodies = 1) {
  SensorFrame f;
  f.sensor = id(sensor);
  f.captured = kT0 + since;
  f.received = kT0 + since + milliseconds(1);
  f.bodies.resize(bodies);
  return f;
}

/// Two sensors at 30 Hz for `length`, starting at `from`; what was due on the way.
std::vector<SolveKind> walk(RegistrationSession& session, Duration from, Duration length) {
  std::vector<SolveKind> due;
  for (Duration t = from; t < from + length; t += milliseconds(33)) {
    session.add(frame("s1", t));
    session.add(frame("s2", t + milliseconds(11)));
    if (const auto kind = session.due()) due.push_back(*kind);
  }
  return due;
}

Registration with(Verdict verdict, std::vector<const char*> sensors) {
  Registration r;
  r.verdict = verdict;
  for (const char* s : sensors) r.sensors[id(s)] = Extrinsics{};
  return r;
}

TEST(RegistrationSession, IsIdleUntilStarted) {
  RegistrationSession session({});
  EXPECT_FALSE(session.collecting());
  EXPECT_TRUE(walk(session, seconds(0), seconds(60)).empty());
  EXPECT_TRUE(session.walk().empty());
}

TEST(RegistrationSession, SolvesProvisionallyFromSixSecondsEveryTwoAndFinallyAtTheTarget) {
  RegistrationSession session({});
  session.start(seconds(12));
  EXPECT_TRUE(walk(session, seconds(0), milliseconds(5900)).empty());
  const auto due = walk(session, milliseconds(5900), seconds(7));
  ASSERT_EQ(due.size(), 4u);  // about 6, 8, 10, then 12
  EXPECT_EQ(due[0], SolveKind::Provisional);
  EXPECT_EQ(due[2], SolveKind::Provisional);
  EXPECT_EQ(due[3], SolveKind::Final);
  EXPECT_FALSE(session.collecting());
  ASSERT_EQ(session.walk().size(), 2u);
  EXPECT_GT(session.walk()[0].frames.size(), 350u);
}

TEST(RegistrationSession, AnEmptyRoomIsNotAWalk) {
  RegistrationSession session({});
  session.start(seconds(30));
  (void)walk(session, seconds(0), seconds(3));
  const Duration before = session.elapsed();
  for (int i = 0; i < 300; ++i) session.add(frame("s1", seconds(3) + milliseconds(33 * i), 0));
  EXPECT_EQ(session.elapsed(), before);
  session.add(frame("s1", seconds(20)));  // back after a pause: the pause does not count
  EXPECT_EQ(session.elapsed(), before);
}

TEST(RegistrationSession, FramesThatGoBackAreLeftOut) {
  RegistrationSession session({});
  session.start(seconds(30));
  session.add(frame("s1", seconds(1)));
  session.add(frame("s1", milliseconds(500)));
  session.add(frame("s1", seconds(1)));
  EXPECT_EQ(session.walk().front().frames.size(), 1u);
}

TEST(RegistrationSession, MemoryIsBounded) {
  SessionConfig config;
  config.max_frames = 10;
  RegistrationSession session(config);
  session.start(std::chrono::hours(1));
  (void)walk(session, seconds(0), seconds(5));
  EXPECT_EQ(session.walk().front().frames.size(), 10u);
}

TEST(RegistrationSession, CancelForgetsAndStartBeginsAnew) {
  RegistrationSession session({});
  session.start(seconds(30));
  (void)walk(session, seconds(0), seconds(8));
  session.cancel();
  EXPECT_FALSE(session.collecting());
  EXPECT_TRUE(session.walk().empty());
  session.start(seconds(20));
  EXPECT_EQ(session.elapsed(), Duration{0});
  EXPECT_EQ(session.target(), seconds(20));
}

TEST(Adoption, AFailingSessionNeverReplacesAnything) {
  const Registration good = with(Verdict::Good, {"s1", "s2"});
  for (const Verdict verdict : {Verdict::None, Verdict::Refused}) {
    EXPECT_FALSE(should_adopt(good, with(verdict, {"s1", "s2", "s3"}), SolveKind::Final));
    EXPECT_FALSE(should_adopt(Registration{}, with(verdict, {"s1"}), SolveKind::Final));
  }
  EXPECT_FALSE(should_adopt(Registration{}, with(Verdict::Good, {}), SolveKind::Final));
}

TEST(Adoption, AnythingUsableReplacesNothing) {
  EXPECT_TRUE(should_adopt(Registration{}, with(Verdict::Provisional, {"s1", "s2"}),
                           SolveKind::Provisional));
}

TEST(Adoption, ProvisionalNeverReplacesGoodUnlessItPlacesMoreSensors) {
  const Registration good = with(Verdict::Good, {"s1", "s2"});
  EXPECT_FALSE(should_adopt(good, with(Verdict::Provisional, {"s1", "s2"}), SolveKind::Final));
  EXPECT_TRUE(should_adopt(good, with(Verdict::Provisional, {"s1", "s2", "s3"}), SolveKind::Final));
}

TEST(Adoption, ASmallerCircleIsNeverAdopted) {
  const Registration three = with(Verdict::Provisional, {"s1", "s2", "s3"});
  EXPECT_FALSE(should_adopt(three, with(Verdict::Good, {"s1", "s2"}), SolveKind::Final));
  EXPECT_FALSE(should_adopt(three, with(Verdict::Good, {"s1", "s2", "s4"}), SolveKind::Final));
}

TEST(Adoption, AFinishedGoodWalkReplacesAnOlderGoodOneButNotHalfway) {
  const Registration good = with(Verdict::Good, {"s1", "s2"});
  EXPECT_TRUE(should_adopt(good, good, SolveKind::Final));
  EXPECT_FALSE(should_adopt(good, good, SolveKind::Provisional));
}

TEST(Adoption, ProvisionalOnesFollowEachOtherDuringAWalk) {
  const Registration provisional = with(Verdict::Provisional, {"s1", "s2"});
  EXPECT_TRUE(should_adopt(provisional, provisional, SolveKind::Provisional));
  EXPECT_TRUE(should_adopt(provisional, with(Verdict::Good, {"s1", "s2"}), SolveKind::Provisional));
}

TEST(Unplaced, NamesTheSensorsThatSeeButHaveNoPlace) {
  const Registration r = with(Verdict::Good, {"s1", "s2"});
  EXPECT_TRUE(unplaced(r, {id("s1"), id("s2")}).empty());
  EXPECT_EQ(unplaced(r, {id("s1"), id("s3")}), std::set<SensorId>{id("s3")});
  EXPECT_EQ(unplaced({}, {id("s1")}).size(), 1u);
}

}  // namespace
}  // namespace chorus::core
