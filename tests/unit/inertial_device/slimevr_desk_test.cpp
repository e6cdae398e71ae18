// Trackers shake hands, speak, repeat themselves and fall silent; without a socket.
#include "services/sensor/device/inertial/slimevr_desk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::inertial_device {
namespace {

namespace slimevr = inertial::slimevr;
using chorus::testing::kStart;
using std::chrono::milliseconds;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

slimevr::Handshake tracker(std::uint8_t last) {
  slimevr::Handshake handshake;
  handshake.mac = {0xAA, 0xBB, 0xCC, 0xDD, 0xEE, last};
  handshake.firmware = "0.6.6";
  return handshake;
}

std::string packet(std::uint64_t number, slimevr::Content content) {
  return slimevr::encode({number, std::move(content)});
}

/// A quarter turn about the vertical of a world with +z up.
slimevr::Rotation turned(std::uint8_t sensor = 0) {
  return {sensor, Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()))};
}

TEST(SlimevrDesk, GreetsTrackersAndTurnsWhatTheySayUpright) {
  SlimevrDesk desk;
  const auto greeted = desk.hear("10.0.0.5:7000", packet(0, tracker(1)), kStart);
  ASSERT_EQ(greeted.size(), 1u);
  EXPECT_EQ(greeted[0].datagram, slimevr::handshake_answer());
  EXPECT_THAT(desk.hear("10.0.0.5:7000", packet(1, turned()), kStart + milliseconds(3)), IsEmpty());
  (void)desk.hear("10.0.0.5:7000", packet(2, slimevr::Battery{3.9, 0.75}),
                  kStart + milliseconds(4));
  (void)desk.hear("10.0.0.5:7000", packet(3, turned(1)), kStart + milliseconds(5));
  const auto instant = desk.instant(kStart + milliseconds(10));
  ASSERT_TRUE(instant);
  ASSERT_EQ(instant->readings.size(), 2u);
  EXPECT_EQ(instant->readings[0].sensor, "AA:BB:CC:DD:EE:01");
  EXPECT_EQ(instant->readings[1].sensor, "AA:BB:CC:DD:EE:01/1");
  EXPECT_EQ(instant->readings[0].captured, kStart + milliseconds(3));
  EXPECT_EQ(instant->readings[0].battery, 0.75);
  EXPECT_EQ(instant->readings[0].magnetic, inertial::MagneticState::None);
  const Eigen::Vector3d up_in_tracker = Eigen::Vector3d::UnitZ();
  EXPECT_LT((*instant->readings[0].inertial_from_sensor * up_in_tracker - Eigen::Vector3d::UnitY())
                .norm(),
            1e-6)
      << "+y is up";
  EXPECT_FALSE(desk.instant(kStart + milliseconds(20))) << "nothing new";
}

TEST(SlimevrDesk, LosesNoneOfATrackerThatIsFasterThanItIsAsked) {
  SlimevrDesk desk;
  (void)desk.hear("a", packet(0, tracker(1)), kStart);
  (void)desk.hear("b", packet(0, tracker(2)), kStart);
  for (int i = 1; i <= 10; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    (void)desk.hear("a", packet(number, turned()), kStart + milliseconds(i));
    if (i == 5) (void)desk.hear("b", packet(1, turned()), kStart + milliseconds(i));
  }
  std::size_t of_a = 0, of_b = 0;
  while (const auto instant = desk.instant(kStart + milliseconds(11))) {
    for (const auto& one : instant->readings) {
      const bool a = one.sensor.ends_with("01");
      (a ? of_a : of_b) += 1;
      EXPECT_EQ(one.captured, kStart + milliseconds(a ? static_cast<int>(of_a) : 5));
    }
  }
  EXPECT_EQ(of_a, 10u);
  EXPECT_EQ(of_b, 1u);
}

TEST(SlimevrDesk, IgnoresStrangersRepeatsAndNonsense) {
  SlimevrDesk desk;
  EXPECT_THAT(desk.hear("a", packet(1, turned()), kStart), IsEmpty());
  EXPECT_THAT(desk.last_refusal(), HasSubstr("shaken hands"));
  (void)desk.hear("a", packet(0, tracker(1)), kStart);
  (void)desk.hear("a", packet(7, turned()), kStart);
  (void)desk.instant(kStart);
  (void)desk.hear("a", packet(7, turned()), kStart + milliseconds(5));
  (void)desk.hear("a", packet(6, turned()), kStart + milliseconds(6));
  (void)desk.hear("a", std::string("nonsense"), kStart + milliseconds(7));
  EXPECT_FALSE(desk.instant(kStart + milliseconds(10)));
  EXPECT_EQ(desk.refused(), 4u);
  (void)desk.hear("a", packet(0, tracker(1)), kStart + milliseconds(20));
  (void)desk.hear("a", packet(1, turned()), kStart + milliseconds(21));
  EXPECT_TRUE(desk.instant(kStart + milliseconds(30))) << "it began anew";
}

TEST(SlimevrDesk, KeepsTrackersWithHeartbeatsAndForgetsTheSilent) {
  SlimevrDesk desk;
  (void)desk.hear("a", packet(0, tracker(1)), kStart);
  (void)desk.hear("b", packet(0, tracker(2)), kStart);
  EXPECT_EQ(desk.heartbeats(kStart).size(), 2u);
  EXPECT_THAT(desk.heartbeats(kStart + milliseconds(100)), IsEmpty());
  (void)desk.hear("b", packet(1, turned()), kStart + std::chrono::seconds(8));
  EXPECT_EQ(desk.heartbeats(kStart + std::chrono::seconds(11)).size(), 1u);
  EXPECT_EQ(desk.trackers(), 1u);
}

TEST(SlimevrDesk, IsTheSameTrackerFromAnotherPortAndHasRoomForSoManyOnly) {
  SlimevrDesk desk;
  (void)desk.hear("a:1", packet(0, tracker(1)), kStart);
  (void)desk.hear("a:2", packet(0, tracker(1)), kStart);
  EXPECT_EQ(desk.trackers(), 1u);
  for (int i = 0; i < 100; ++i)
    (void)desk.hear("b:" + std::to_string(i), packet(0, tracker(static_cast<std::uint8_t>(i + 2))),
                    kStart);
  EXPECT_EQ(desk.trackers(), SlimevrDesk::kMostTrackers);
}

}  // namespace
}  // namespace chorus::inertial_device
