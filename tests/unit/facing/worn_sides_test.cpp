// Worn inertial sensors as a witness of which side is the left one.
#include "fusion-server/facing/worn_sides.h"

#include <gtest/gtest.h>

#include "common/evaluation/limb_frame.h"
#include "fusion-server/facing/sides.h"
#include "tests/unit/facing/posed_body.h"

namespace chorus::facing {
namespace {

using inertial::Limb;

constexpr Timestamp kWornStart = from_unix_ns(1'790'000'000'000'000'000);
constexpr Duration kWornFrame = std::chrono::milliseconds(33);

/// What sensors on these limbs of a body say, without error.
std::vector<WornLimb> worn_on(const Skeleton<WorldSpace>& body, const std::vector<Limb>& limbs) {
  std::vector<WornLimb> worn;
  for (const Limb limb : limbs)
    worn.push_back({SensorId::parse("suit").value(), limb,
                    evaluation::limb_from_joints(body, limb)->world_from_limb,
                    deg(5) * deg(5) * Eigen::Matrix3d::Identity()});
  return worn;
}

/// The left arm points to the side.
Skeleton<WorldSpace> left_arm_aside() {
  auto body = body_at({0, 0, 0}, 0);
  body[JointId::ElbowLeft].position =
      body[JointId::ShoulderLeft].position + Eigen::Vector3d(.3, 0, 0);
  body[JointId::WristLeft].position =
      body[JointId::ElbowLeft].position + Eigen::Vector3d(.25, 0, 0);
  return body;
}

/// Whether a single sensor behind somebody, who it takes for facing it, is put right.
bool put_right(const Skeleton<WorldSpace>& exact, const std::vector<WornLimb>& worn) {
  Person person{PersonId{1}, {view_from(1, deg(180), exchanged(exact))}};
  person.worn = worn;
  SidesMemory memory;
  resolve_sides(person, kWornStart, memory, {});
  return is_right(person.views[0], exact);
}

TEST(WornSides, AChestSensorTellsTheFrontOfWhoTurnsTheirBackOnTheOnlySensor) {
  const auto exact = body_at({0, 0, 0}, 0);
  EXPECT_FALSE(put_right(exact, {})) << "nothing else tells it";
  EXPECT_TRUE(put_right(exact, worn_on(exact, {Limb::Chest})));
}

TEST(WornSides, SensorsOnAnArmTellWhichArmItIs) {
  const auto exact = left_arm_aside();
  EXPECT_FALSE(put_right(exact, {}));
  EXPECT_TRUE(put_right(exact, worn_on(exact, {Limb::UpperArmLeft, Limb::ForearmLeft})));
}

TEST(WornSides, ArmsThatHangAlikeTellNothing) {
  const auto exact = body_at({0, 0, 0}, 0);
  Person person{PersonId{1}, {view_from(1, 0, exact)}};
  person.worn = worn_on(exact, {Limb::ForearmLeft, Limb::ForearmRight});
  EXPECT_NEAR(worn_log_odds(person, {false}, {}, {}), 0.0, 0.1);
}

TEST(WornSides, TheirSayIsLimitedAndTurnsWithTheHeldSides) {
  const auto exact = left_arm_aside();
  Person person{PersonId{1}, {view_from(1, 0, exact), view_from(2, deg(60), exchanged(exact))}};
  person.worn = worn_on(exact, {Limb::Pelvis, Limb::Chest, Limb::UpperArmLeft, Limb::ForearmLeft});
  const double held = worn_log_odds(person, {false, true}, {}, {});
  EXPECT_NEAR(held, 3.9, 0.1);
  EXPECT_NEAR(worn_log_odds(person, {true, false}, {}, {}), -held, 1e-9);
}

TEST(WornSides, ASensorOnTheWrongSideDoesNotTurnWhoIsSeenFromTheFront) {
  const auto exact = body_at({0, 0, 0}, 0, kAtWork);
  SidesMemory memory;
  Person person{PersonId{1}, {}};
  for (int i = 0; i < 300; ++i) {
    person.views = {view_from(1, 0, exact), view_from(2, deg(60), exact)};
    if (i > 150) person.worn = worn_on(body_at({0, 0, 0}, deg(180)), {Limb::Chest});
    resolve_sides(person, kWornStart + i * kWornFrame, memory, {});
  }
  EXPECT_TRUE(is_right(person.views[0], exact));
}

}  // namespace
}  // namespace chorus::facing
