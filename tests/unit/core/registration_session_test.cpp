// A walk is collected, shared with its solver, and solved in time.
#include "fusion-server/core/registration_session.h"

#include <gtest/gtest.h>

namespace chorus::core {
namespace {

using std::chrono::milliseconds;

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

/// Two sensors at 30 Hz for `length`, starting at `from`; returns the solves that became due.
std::vector<SolveKind> walk(RegistrationSession& session, Duration from, Duration length) {
  std::vector<SolveKind> due;
  for (Duration t = from; t < from + length; t += milliseconds(33)) {
    session.add(frame("s1", t));
    session.add(frame("s2", t + milliseconds(11)));
    if (const auto kind = session.due()) due.push_back(*kind);
  }
  return due;
}

std::size_t frames_of(const SharedTrack& track) {
  std::size_t frames = 0;
  for (const auto& chunk : track.chunks) frames += chunk->size();
  return frames;
}

TEST(RegistrationSession, IsIdleUntilStarted) {
  RegistrationSession session({});
  EXPECT_FALSE(session.collecting());
  EXPECT_TRUE(walk(session, std::chrono::seconds(0), std::chrono::seconds(60)).empty());
  EXPECT_TRUE(session.walk().empty());
}

TEST(RegistrationSession, SolvesProvisionallyFromSixSecondsEveryTwoAndFinallyAtTheTarget) {
  RegistrationSession session({});
  session.start(std::chrono::seconds(12));
  EXPECT_TRUE(walk(session, std::chrono::seconds(0), milliseconds(5900)).empty());
  const auto due = walk(session, milliseconds(5900), std::chrono::seconds(7));
  ASSERT_EQ(due.size(), 4u);  // due after about 6, 8, 10 and 12 s
  EXPECT_EQ(due[0], SolveKind::Provisional);
  EXPECT_EQ(due[2], SolveKind::Provisional);
  EXPECT_EQ(due[3], SolveKind::Final);
  EXPECT_FALSE(session.collecting());
  const SharedWalk whole = session.walk();
  ASSERT_EQ(whole.size(), 2u);
  EXPECT_GT(frames_of(whole[0]), 350u);
}

TEST(RegistrationSession, AnEmptyRoomIsNotAWalk) {
  RegistrationSession session({});
  session.start(std::chrono::seconds(30));
  (void)walk(session, std::chrono::seconds(0), std::chrono::seconds(3));
  const Duration before = session.elapsed();
  for (int i = 0; i < 300; ++i)
    session.add(frame("s1", std::chrono::seconds(3) + milliseconds(33 * i), 0));
  EXPECT_EQ(session.elapsed(), before);
  session.add(frame("s1", std::chrono::seconds(20)));  // back after a pause, which does not count
  EXPECT_EQ(session.elapsed(), before);
}

TEST(RegistrationSession, FramesThatGoBackAreLeftOut) {
  RegistrationSession session({});
  session.start(std::chrono::seconds(30));
  session.add(frame("s1", std::chrono::seconds(1)));
  session.add(frame("s1", milliseconds(500)));
  session.add(frame("s1", std::chrono::seconds(1)));
  EXPECT_EQ(frames_of(session.walk().front()), 1u);
}

TEST(RegistrationSession, MemoryIsBounded) {
  SessionConfig config;
  config.max_frames = 10;
  RegistrationSession session(config);
  session.start(std::chrono::hours(1));
  (void)walk(session, std::chrono::seconds(0), std::chrono::seconds(5));
  EXPECT_EQ(frames_of(session.walk().front()), 10u);
}

TEST(RegistrationSession, CancelForgetsAndStartBeginsAnew) {
  RegistrationSession session({});
  session.start(std::chrono::seconds(30));
  (void)walk(session, std::chrono::seconds(0), std::chrono::seconds(8));
  session.cancel();
  EXPECT_FALSE(session.collecting());
  EXPECT_TRUE(session.walk().empty());
  session.start(std::chrono::seconds(20));
  EXPECT_EQ(session.elapsed(), Duration{0});
  EXPECT_EQ(session.target(), std::chrono::seconds(20));
}

TEST(RegistrationSession, TheWalkIsSharedAndNotCopied) {
  RegistrationSession session({});
  session.start(std::chrono::seconds(60));
  (void)walk(session, std::chrono::seconds(0), std::chrono::seconds(8));
  const SharedWalk first = session.walk();
  (void)walk(session, std::chrono::seconds(8), std::chrono::seconds(2));
  const SharedWalk second = session.walk();
  ASSERT_EQ(first.size(), 2u);
  for (std::size_t i = 0; i < first[0].chunks.size(); ++i)
    EXPECT_EQ(first[0].chunks[i].get(), second[0].chunks[i].get());
  EXPECT_GT(frames_of(second[0]), frames_of(first[0]));
  const auto tracks = assembled(second);
  ASSERT_EQ(tracks[0].frames.size(), frames_of(second[0]));
  for (std::size_t i = 1; i < tracks[0].frames.size(); ++i)
    EXPECT_LT(tracks[0].frames[i - 1].captured, tracks[0].frames[i].captured);
}

TEST(RegistrationSession, TheWholeWalkIsHandedOverAtItsEnd) {
  RegistrationSession session({});
  session.start(std::chrono::seconds(8));
  const auto due = walk(session, std::chrono::seconds(0), std::chrono::seconds(9));
  ASSERT_EQ(due.back(), SolveKind::Final);
  const SharedWalk last = session.walk();
  EXPECT_GT(frames_of(last[0]), 230u);
  EXPECT_EQ(last[0].chunks.front().use_count(), 1) << "nobody else keeps it in memory";
  EXPECT_TRUE(session.walk().empty());
}

TEST(RegistrationSession, ASlowSolveRestsTwiceAsLongAsItWorked) {
  RegistrationSession session({});
  session.start(std::chrono::seconds(60));
  EXPECT_EQ(walk(session, std::chrono::seconds(0), std::chrono::seconds(7)).size(), 1u);
  session.solved_in(std::chrono::seconds(3));
  EXPECT_TRUE(walk(session, std::chrono::seconds(7), milliseconds(7500)).empty());
  // The first solve took 3 s and is followed by a rest of 6 s, so the next one is due now.
  EXPECT_EQ(walk(session, milliseconds(14500), std::chrono::seconds(1)).size(), 1u);
}

}  // namespace
}  // namespace chorus::core
