// One pusher: its clock, its rate, and what it must not do.
#include "services/sensor/device/bridge/push_session.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/unit/push/push_rig.h"

namespace chorus::bridge {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

const std::string kSessionHello = R"({"type":"hello","name":"cam","layout":"coco_17"})";

std::string text(Timestamp t) { return "\"" + std::to_string(to_unix_ns(t)) + "\""; }

std::string frame_at(Timestamp captured) {
  return R"({"type":"frame","bodies":[],"captured":)" + text(captured) + "}";
}

class Session : public ::testing::Test {
 protected:
  explicit Session(BridgeSettings settings = {}) : rig(std::move(settings)) {}

  [[nodiscard]] Result<Heard> hear(const std::string& message) { return session.hear(message); }
  /// The answer of a clock `ahead` of ours, with a delay of 1 ms in each direction.
  [[nodiscard]] Result<Heard> answer_clock(Duration ahead) {
    const Timestamp asked = rig.clock->now();
    rig.pass(milliseconds(2));
    const Timestamp theirs = asked + milliseconds(1) + ahead;
    return hear(R"({"type":"clock","sent":)" + text(asked) + R"(,"received":)" + text(theirs) +
                R"(,"answered":)" + text(theirs) + "}");
  }
  [[nodiscard]] Timestamp captured() {
    const auto captures = captures_of(*rig.desk);
    EXPECT_FALSE(captures.empty());
    return captures.empty() ? Timestamp{} : captures.back().frame.captured;
  }

  PushRig rig;
  PushSession session{rig.desk, "WebSocket", "127.0.0.1"};
};

TEST_F(Session, AShapeBesidePixelsMakesPoints) {
  std::ifstream lines("proto/golden/bridge/world.jsonl");
  std::string hello;
  std::string frame;
  ASSERT_TRUE(std::getline(lines, hello) && std::getline(lines, frame));
  ASSERT_THAT(hear(hello), IsOk());
  const std::string stamp = "\"1795246200250000000\"";
  frame.replace(frame.find(stamp), stamp.size(), text(rig.clock->now()));
  ASSERT_THAT(hear(frame), IsOk());
  const auto captures = captures_of(*rig.desk);
  ASSERT_EQ(captures.size(), 1u);
  const auto& bodies = captures[0].frame.bodies;
  ASSERT_EQ(bodies.size(), 2u);
  const Joint& hips = bodies[0].skeleton[JointId::SpineBase];
  EXPECT_TRUE(hips.seen() && hips.covariance.known());
  EXPECT_LT((hips.position - Eigen::Vector3d(-0.4, -0.1, 3.2)).norm(), 0.05);
  EXPECT_TRUE(bodies[0].skeleton[JointId::WristRight].bears()) << "the shape lacks it";
  EXPECT_TRUE(bodies[1].skeleton[JointId::Head].bears()) << "no shape";
}

TEST_F(Session, AWrongClockIsEstimatedAndTakenOff) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  const Duration ahead = std::chrono::hours(1);
  ASSERT_THAT(answer_clock(ahead), IsOk());
  const Timestamp when = rig.clock->now() - milliseconds(40);
  ASSERT_THAT(hear(frame_at(when + ahead)), IsOk());
  EXPECT_LE(std::chrono::abs(captured() - when), milliseconds(1)) << "half of the way at most";
  ASSERT_TRUE(rig.desk->status().clock);
  EXPECT_LE(rig.desk->status().clock->uncertainty, milliseconds(2));
}

TEST_F(Session, FramesBeforeTheFirstAnswerAreLeftOutForASecond) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  session.expect_clock();
  const Duration ahead = std::chrono::hours(1);
  EXPECT_EQ(*hear(frame_at(rig.clock->now() + ahead)), Heard::LeftOut);
  ASSERT_THAT(answer_clock(ahead), IsOk());
  EXPECT_EQ(*hear(frame_at(rig.clock->now() + ahead)), Heard::Frame);
  PushSession mute(rig.desk, "WebSocket", "");
  rig.pass(std::chrono::seconds(3));
  ASSERT_THAT(mute.hear(kSessionHello), IsOk());
  mute.expect_clock();
  EXPECT_EQ(*mute.hear(frame_at(rig.clock->now())), Heard::LeftOut);
  rig.pass(milliseconds(1001));
  EXPECT_EQ(*mute.hear(frame_at(rig.clock->now())), Heard::Frame) << "it never answers";
}

TEST_F(Session, AClockThatCountsMillisecondsIsGoodEnough) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  const auto whole_ms = [](Timestamp t) {
    return from_unix_ns(to_unix_ns(t) / 1'000'000 * 1'000'000);
  };
  for (int i = 0; i < 60; ++i) {
    const Timestamp asked = rig.clock->now();
    rig.pass(std::chrono::microseconds(37 + 11 * (i % 17)));
    const std::string theirs = text(whole_ms(rig.clock->now() - std::chrono::hours(2)));
    rig.pass(std::chrono::microseconds(50));
    ASSERT_THAT(hear(R"({"type":"clock","sent":)" + text(asked) + R"(,"received":)" + theirs +
                     R"(,"answered":)" + theirs + "}"),
                IsOk());
    rig.pass(std::chrono::microseconds(16'789));
    const Timestamp when = rig.clock->now() - milliseconds(5);
    ASSERT_EQ(*hear(frame_at(when - std::chrono::hours(2))), Heard::Frame) << i;
    EXPECT_LE(std::chrono::abs(captured() - when), milliseconds(1));
  }
}

TEST_F(Session, AnOffsetSmallerThanItsBoundIsTakenOffToo) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  ASSERT_THAT(answer_clock(std::chrono::microseconds(1500)), IsOk());
  const Timestamp when = rig.clock->now() - milliseconds(20);
  ASSERT_THAT(hear(frame_at(when + std::chrono::microseconds(1500))), IsOk());
  EXPECT_EQ(captured(), when);
}

TEST_F(Session, WithoutAnswersTheClockHasToBeRight) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  EXPECT_THAT(hear(frame_at(rig.clock->now() - milliseconds(30))), IsOk());
  for (const Duration off : {Duration(std::chrono::seconds(3)), Duration(-std::chrono::seconds(11)),
                             Duration(std::chrono::hours(-9))}) {
    const auto heard = hear(frame_at(rig.clock->now() + off));
    ASSERT_THAT(heard, FailsWith(ErrorCode::InvalidArgument));
    EXPECT_EQ(heard.error().context, "captured");
    EXPECT_THAT(heard.error().message, HasSubstr("set your clock"));
    EXPECT_THAT(heard.error().message, HasSubstr(off > Duration{0} ? "in the future" : "ago"));
  }
}

TEST_F(Session, AFrameFromTheFutureIsALie) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  ASSERT_THAT(answer_clock(std::chrono::seconds(5)), IsOk());
  const auto heard = hear(frame_at(rig.clock->now() + std::chrono::seconds(5) + milliseconds(300)));
  ASSERT_THAT(heard, FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(heard.error().message, HasSubstr("0.3"));
  EXPECT_THAT(heard.error().message, HasSubstr("in the future; stamp frames by the clock"));
}

TEST_F(Session, StampsThatCannotBeTrueChangeNothing) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  ASSERT_THAT(answer_clock(std::chrono::seconds(0)), IsOk());
  const Timestamp now = rig.clock->now();
  // Three impossible exchanges: answered before the question; held longer than the round trip;
  // asked in the future.
  EXPECT_THAT(
      hear(R"({"type":"clock","sent":)" + text(now - std::chrono::seconds(1)) + R"(,"received":)" +
           text(now) + R"(,"answered":)" + text(now - std::chrono::seconds(1)) + "}"),
      IsOk());
  EXPECT_THAT(
      hear(R"({"type":"clock","sent":)" + text(now - std::chrono::seconds(1)) + R"(,"received":)" +
           text(now) + R"(,"answered":)" + text(now + std::chrono::hours(1)) + "}"),
      IsOk());
  EXPECT_THAT(hear(R"({"type":"clock","sent":)" + text(now + std::chrono::seconds(9)) +
                   R"(,"received":)" + text(now) + R"(,"answered":)" + text(now) + "}"),
              FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(hear(frame_at(rig.clock->now() - milliseconds(10))), IsOk());
  EXPECT_EQ(captured(), rig.clock->now() - milliseconds(10));
}

TEST_F(Session, ClocksAtTheEndsOfTimeAreNoHarm) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  const Timestamp asked = rig.clock->now();
  rig.pass(milliseconds(2));
  for (const std::string far : {"1000000000000000000", "8000000000000000000"}) {
    ASSERT_THAT(hear(R"({"type":"clock","sent":)" + text(asked) + R"(,"received":")" + far +
                     R"(","answered":")" + far + "\"}"),
                IsOk());
    for (const std::string when : {"1000000000000000000", "8000000000000000000"})
      (void)hear(R"({"type":"frame","bodies":[],"captured":")" + when + "\"}");
  }
  EXPECT_FALSE(session.lost());
}

TEST_F(Session, AClockThatWasSetIsLearntAnew) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  for (int i = 0; i < 10; ++i) ASSERT_THAT(answer_clock(Duration{0}), IsOk());
  EXPECT_FALSE(session.wants_clock());
  ASSERT_THAT(answer_clock(std::chrono::seconds(60)), IsOk());
  EXPECT_TRUE(session.wants_clock()) << "in doubt: ask again at once";
  EXPECT_THAT(hear(frame_at(rig.clock->now() + std::chrono::seconds(60))),
              FailsWith(ErrorCode::Unavailable));
  for (int i = 0; i < 3; ++i) ASSERT_THAT(answer_clock(std::chrono::seconds(60)), IsOk());
  const Timestamp when = rig.clock->now() - milliseconds(20);
  ASSERT_THAT(hear(frame_at(when + std::chrono::seconds(60))), IsOk());
  EXPECT_LE(std::chrono::abs(captured() - when), milliseconds(2));
}

TEST_F(Session, FramesBeyondTheRateAreLeftOut) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  int taken = 0;
  int left_out = 0;
  for (int i = 0; i < 300; ++i) {
    rig.pass(milliseconds(4));  // 250 per second, where 120 are allowed
    const auto heard = hear(frame_at(rig.clock->now()));
    ASSERT_THAT(heard, IsOk());
    (*heard == Heard::Frame ? taken : left_out) += 1;
  }
  EXPECT_NEAR(taken, 120 + 144, 3) << "a second's worth at once, then the rate";
  EXPECT_EQ(left_out, 300 - taken);
  EXPECT_EQ(rig.desk->status().left_out, static_cast<std::uint64_t>(left_out));
  EXPECT_FALSE(session.lost());
}

TEST_F(Session, AFloodEndsIt) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  Result<Heard> heard = Heard::Frame;
  int messages = 0;
  while (!session.lost() && messages < 10'000) {
    heard = hear("{}");
    ++messages;
  }
  EXPECT_LE(messages, 4 * 120 + 1);
  ASSERT_THAT(heard, FailsWith(ErrorCode::Unavailable));
  EXPECT_THAT(heard.error().message, HasSubstr("480 messages"));
  EXPECT_THAT(rig.desk->connect("WebSocket"), FailsWith(ErrorCode::Unavailable))
      << "not at once again";
}

TEST_F(Session, SoDoTooManyBytes) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  const std::string large(200'000, ' ');
  int messages = 0;
  while (!session.lost() && messages < 100) {
    (void)hear(large);
    ++messages;
  }
  EXPECT_LE(messages, 21) << "four megabytes";
}

TEST_F(Session, AMessageThatIsTooLongIsRefusedUnread) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  const auto heard = hear(std::string(256 * 1024 + 1, ' '));
  ASSERT_THAT(heard, FailsWith(ErrorCode::TooLarge));
  EXPECT_THAT(heard.error().message, HasSubstr("max_message_kb"));
}

TEST_F(Session, AWrongHelloIsTheEnd) {
  EXPECT_THAT(hear(R"({"type":"hello","name":"cam","layout":"centaur"})"),
              FailsWith(ErrorCode::Malformed));
  EXPECT_TRUE(session.lost());
}

TEST_F(Session, ASecondHelloChangesTheCameraButNotTheName) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  EXPECT_THAT(hear(R"({"type":"hello","name":"cam","layout":"body_25"})"), IsOk());
  EXPECT_EQ(session.hello()->layout->name, "body_25");
  EXPECT_THAT(hear(R"({"type":"hello","name":"other","layout":"body_25"})"),
              FailsWith(ErrorCode::Conflict));
}

TEST_F(Session, WhoIsReplacedIsToldSo) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  rig.pass(std::chrono::seconds(3));
  PushSession other(rig.desk, "HTTP POST", "");
  ASSERT_THAT(other.hear(kSessionHello), IsOk());
  const auto heard = hear(frame_at(rig.clock->now()));
  ASSERT_THAT(heard, FailsWith(ErrorCode::Conflict));
  EXPECT_TRUE(session.lost());
}

TEST_F(Session, ItsEndFreesTheSensor) {
  {
    PushSession short_one(rig.desk, "WebSocket", "");
    ASSERT_THAT(short_one.hear(kSessionHello), IsOk());
    EXPECT_THAT(hear(kSessionHello), FailsWith(ErrorCode::Conflict));
  }
  PushSession next(rig.desk, "WebSocket", "");
  EXPECT_THAT(next.hear(kSessionHello), IsOk());
}

struct WornSession : Session {
  WornSession() : Session(BridgeSettings{.orientations = true}) {}
  [[nodiscard]] std::string said_at(Timestamp captured, const char* readings) const {
    return R"({"type":"orientations","captured":)" + text(captured) + R"(,"readings":)" + readings +
           "}";
  }
  static constexpr const char* kPelvis =
      R"({"pelvis":{"limb":"Pelvis","qx":0,"qy":0.6,"qz":0,"qw":0.8,"battery":0.5}})";
};

TEST_F(WornSession, WhatWornSensorsSayIsTakenLikeAFrameByTheClockOfThePusher) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  for (int i = 0; i < 8; ++i) ASSERT_THAT(answer_clock(std::chrono::seconds(-7)), IsOk());
  const Timestamp now = rig.clock->now();
  ASSERT_THAT(hear(said_at(now - std::chrono::seconds(7), kPelvis)), IsOk());
  const auto pushed = rig.desk->pushed(Duration{0});
  ASSERT_EQ(pushed.size(), 1u);
  const auto& instant = std::get<inertial::InertialFrame>(pushed[0]);
  EXPECT_LT(std::chrono::abs(instant.captured - now), milliseconds(3));
  EXPECT_EQ(instant.sequence, 1u);
  EXPECT_EQ(instant.source.str(), "s1");
  ASSERT_EQ(instant.readings.size(), 1u);
  EXPECT_EQ(instant.readings[0].captured, instant.captured);
  EXPECT_EQ(instant.readings[0].limb, inertial::Limb::Pelvis);
  EXPECT_NEAR(instant.readings[0].inertial_from_sensor->y(), 0.6, 1e-12);
}

TEST_F(WornSession, MistakesAreNamedAndTimeAdvances) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  const Timestamp now = rig.clock->now();
  ASSERT_THAT(hear(said_at(now, kPelvis)), IsOk());
  EXPECT_THAT(hear(said_at(now, kPelvis)), FailsWith(ErrorCode::Conflict)) << "the same again";
  EXPECT_THAT(hear(frame_at(now)), IsOk()) << "frames have times of their own";
  const auto wrong = hear(said_at(now + milliseconds(1), R"({"pelvis":{"qx":0,"qy":5}})"));
  ASSERT_FALSE(wrong);
  EXPECT_THAT(to_string(wrong.error()), HasSubstr("pelvis"));
}

TEST_F(Session, OrientationsAreRefusedWithAdviceWhereNobodyWantsThem) {
  ASSERT_THAT(hear(kSessionHello), IsOk());
  const auto refused =
      hear(R"({"type":"orientations","readings":{},"captured":)" + text(rig.clock->now()) + "}");
  ASSERT_FALSE(refused);
  EXPECT_THAT(to_string(refused.error()), HasSubstr("device.bridge.orientations"));
}

}  // namespace
}  // namespace chorus::bridge
