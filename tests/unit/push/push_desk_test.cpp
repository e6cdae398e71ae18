// Which pusher holds the sensor, and how that is reported.
#include "services/sensor/device/bridge/push_desk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/unit/push/push_rig.h"

namespace chorus::bridge {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using std::chrono::milliseconds;
using ::testing::HasSubstr;
using ::testing::Not;

class Desk : public ::testing::Test {
 protected:
  [[nodiscard]] Result<PushDesk::Seat> sit(const std::string& name) {
    return rig.desk->sit_down({name, "coco_17", "WebSocket", "10.0.0.5"});
  }
  [[nodiscard]] Result<void> push(PushDesk::Seat seat, Duration after,
                                  std::optional<std::uint64_t> count = std::nullopt) {
    PushedFrame frame;
    frame.captured = kStart + after;
    frame.sequence = count;
    return rig.desk->take(seat, std::move(frame), hello);
  }
  PushRig rig;
  Hello hello;
};

TEST_F(Desk, OneProgramHoldsTheSensorWhileItPushes) {
  const auto first = sit("first");
  ASSERT_THAT(first, IsOk());
  rig.pass(std::chrono::seconds(1));
  ASSERT_THAT(push(*first, milliseconds(0)), IsOk());
  rig.pass(std::chrono::seconds(1));
  const auto second = sit("second");
  ASSERT_THAT(second, FailsWith(ErrorCode::Conflict));
  EXPECT_THAT(second.error().message, HasSubstr("\"first\" (WebSocket from 10.0.0.5)"));
}

TEST_F(Desk, ASilentOneMakesRoomAndIsRefusedAfterwards) {
  const auto first = sit("first");
  ASSERT_THAT(push(*first, milliseconds(0)), IsOk());
  rig.pass(milliseconds(2100));
  const auto second = sit("second");
  ASSERT_THAT(second, IsOk());
  EXPECT_FALSE(rig.desk->sits(*first));
  EXPECT_THAT(push(*first, milliseconds(2200)), FailsWith(ErrorCode::Conflict));
  EXPECT_THAT(push(*second, milliseconds(2200)), IsOk());
  rig.desk->leave(*first, "late");
  EXPECT_TRUE(rig.desk->sits(*second)) << "who has lost the seat cannot give it up";
}

TEST_F(Desk, WhoLeavesMakesRoomAtOnce) {
  const auto first = sit("first");
  rig.desk->leave(*first, "the connection ended");
  EXPECT_THAT(rig.desk->status().reason, HasSubstr("\"first\" (WebSocket from 10.0.0.5) left"));
  EXPECT_THAT(sit("second"), IsOk());
}

TEST_F(Desk, TimeAdvancesOrWasSet) {
  const auto seat = sit("one");
  ASSERT_THAT(push(*seat, milliseconds(100)), IsOk());
  const auto again = push(*seat, milliseconds(100));
  ASSERT_THAT(again, FailsWith(ErrorCode::Conflict));
  EXPECT_EQ(again.error().context, "captured");
  EXPECT_THAT(push(*seat, milliseconds(99)), FailsWith(ErrorCode::Conflict));
  EXPECT_THAT(push(*seat, -std::chrono::seconds(5)), IsOk()) << "a clock that was set";
}

TEST_F(Desk, TimeThatWasSetBackALittleIsBelievedTheSecondTime) {
  const auto seat = sit("one");
  ASSERT_THAT(push(*seat, milliseconds(1000)), IsOk());
  EXPECT_THAT(push(*seat, milliseconds(600)), FailsWith(ErrorCode::Conflict));
  EXPECT_THAT(push(*seat, milliseconds(600)), FailsWith(ErrorCode::Conflict)) << "the same again";
  EXPECT_THAT(push(*seat, milliseconds(633)), IsOk());
  EXPECT_THAT(push(*seat, milliseconds(666)), IsOk());
}

TEST_F(Desk, GapsInItsOwnCountAreLostFrames) {
  const auto seat = sit("one");
  ASSERT_THAT(push(*seat, milliseconds(0), 10), IsOk());
  ASSERT_THAT(push(*seat, milliseconds(33), 11), IsOk());
  ASSERT_THAT(push(*seat, milliseconds(66), 14), IsOk());
  ASSERT_THAT(push(*seat, milliseconds(99), 2), IsOk()) << "its count began anew";
  std::vector<std::uint64_t> numbers;
  for (const Capture& capture : captures_of(*rig.desk)) numbers.push_back(capture.frame.sequence);
  EXPECT_EQ(numbers, (std::vector<std::uint64_t>{1, 2, 5, 6}));
}

TEST_F(Desk, FramesCarryTheSensorAndTheFloor) {
  hello.floor = FloorPlane{Eigen::Vector3d::UnitY(), 1.4};
  ASSERT_THAT(push(*sit("one"), milliseconds(5)), IsOk());
  const auto captures = captures_of(*rig.desk);
  ASSERT_EQ(captures.size(), 1U);
  EXPECT_EQ(captures[0].frame.sensor.str(), "s1");
  EXPECT_EQ(captures[0].frame.captured, kStart + milliseconds(5));
  EXPECT_EQ(captures[0].frame.received, rig.clock->now());
  EXPECT_EQ(captures[0].frame.floor, hello.floor);
}

TEST_F(Desk, TheFloorOfAProgramEndsWithIt) {
  const auto begins_anew = [&](PushDesk::Seat seat, milliseconds at) {
    EXPECT_THAT(push(seat, at), IsOk());
    const auto captures = captures_of(*rig.desk);
    return captures.size() == 1 && captures[0].begins_anew;
  };
  hello.floor = FloorPlane{Eigen::Vector3d::UnitY(), 1.4};
  const auto first = sit("first");
  EXPECT_TRUE(begins_anew(*first, milliseconds(5)));
  EXPECT_FALSE(begins_anew(*first, milliseconds(10)));
  hello.floor.reset();
  EXPECT_TRUE(begins_anew(*first, milliseconds(15))) << "a new hello took the floor back";
  EXPECT_FALSE(begins_anew(*first, milliseconds(20))) << "a floor of its frames lasts";
  rig.desk->leave(*first, "it was ended");
  EXPECT_TRUE(begins_anew(*sit("second"), milliseconds(25)));
}

TEST_F(Desk, SaysWhyTheLastHelloWasRefused) {
  const auto seat = sit("one");
  rig.desk->note_refusal(0, {ErrorCode::Conflict, "s1", "\"one\" pushes to this sensor already"});
  rig.desk->leave(*seat, "the connection ended");
  EXPECT_THAT(rig.desk->status().reason, HasSubstr("left: the connection ended"));
  rig.desk->note_refusal(0, {ErrorCode::Malformed, "layout", "there is no such layout"});
  EXPECT_THAT(rig.desk->status().reason, HasSubstr("refused: layout: there is no such layout"));
  rig.desk->leave(*sit("two"), "the connection ended");
  EXPECT_THAT(rig.desk->status().reason, Not(HasSubstr("layout")));
}

TEST_F(Desk, SaysWhyNothingComes) {
  EXPECT_EQ(rig.desk->status().state, "waiting");
  EXPECT_EQ(rig.desk->status().reason, "no program pushes frames");
  const auto seat = sit("one");
  EXPECT_THAT(rig.desk->status().reason, HasSubstr("pushes no frames"));
  ASSERT_THAT(push(*seat, milliseconds(0)), IsOk());
  EXPECT_EQ(rig.desk->status().state, "live");
  EXPECT_EQ(rig.desk->status().reason, "");
  rig.pass(std::chrono::seconds(7));
  EXPECT_EQ(rig.desk->status().state, "silent");
  EXPECT_THAT(rig.desk->status().reason, HasSubstr("has pushed no frame for 7 s"));
  rig.desk->note_refusal(*seat, {ErrorCode::Malformed, "captured", "is missing"});
  EXPECT_THAT(rig.desk->status().reason, HasSubstr("captured: is missing"));
  EXPECT_EQ(rig.desk->status().refused, 1U);
}

TEST_F(Desk, WhoSaysNothingMakesRoomForTheNext) {
  std::vector<PushDesk::Guest> silent;
  for (int i = 0; i < 16; ++i) silent.push_back(*rig.desk->connect("local socket"));
  rig.desk->greeted(silent[0]);
  silent.push_back(*rig.desk->connect("local socket"));
  for (const auto guest : silent) EXPECT_FALSE(rig.desk->must_leave(guest));
  const auto next = rig.desk->connect("local socket");
  ASSERT_THAT(next, IsOk());
  EXPECT_FALSE(rig.desk->must_leave(silent[0])) << "it has said hello";
  EXPECT_TRUE(rig.desk->must_leave(silent[1])) << "the oldest that has not";
  EXPECT_FALSE(rig.desk->must_leave(silent[2]));
  EXPECT_FALSE(rig.desk->must_leave(*next));
}

TEST_F(Desk, SilentOnesOfOneWayTakeNoPlaceOfAnother) {
  const auto waiting = *rig.desk->connect("WebSocket");
  for (int i = 0; i < 60; ++i) EXPECT_THAT(rig.desk->connect("local socket"), IsOk());
  EXPECT_FALSE(rig.desk->must_leave(waiting));
  EXPECT_THAT(rig.desk->connect("WebSocket"), IsOk());
}

TEST_F(Desk, AFloodOfSilentOnesIsBounded) {
  int in = 0;
  for (int i = 0; i < 1000; ++i) in += rig.desk->connect("local socket").has_value() ? 1 : 0;
  EXPECT_EQ(in, 16 + 64);
}

TEST_F(Desk, IsShutForASecondAfterAFlood) {
  rig.desk->shut_for_a_moment();
  EXPECT_THAT(rig.desk->connect("WebSocket"), FailsWith(ErrorCode::Unavailable));
  rig.pass(milliseconds(1001));
  EXPECT_THAT(rig.desk->connect("WebSocket"), IsOk());
}

}  // namespace
}  // namespace chorus::bridge
