// Things in hands: where they are, that they do not jump, and who may take them up.
#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/workplace/prop_board.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::workplace {
namespace {

using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using chorus::testing::VectorNear;
using Eigen::Vector3d;
using enum JointId;

/// Faces +z, forearms level and ahead, hands 0.3 m apart and 1.1 m high.
Skeleton<WorldSpace> carrying(const Vector3d& at = Vector3d::Zero(), double yaw = 0.0) {
  Skeleton<WorldSpace> body = chorus::testing::standing_person({0, 0, 0});
  const auto put = [&](JointId id, const Vector3d& place) {
    body[id].position = place;
    body[id].state = JointState::Tracked;
  };
  put(ElbowLeft, {0.15, 1.1, 0.1});
  put(ElbowRight, {-0.15, 1.1, 0.1});
  for (const auto& [left, right] : {std::pair{WristLeft, WristRight}, {HandLeft, HandRight}}) {
    put(left, {0.15, 1.1, left == HandLeft ? 0.42 : 0.35});
    put(right, {-0.15, 1.1, left == HandLeft ? 0.42 : 0.35});
  }
  for (Joint& joint : body.joints) {
    joint.position = at + about_y(yaw) * joint.position;
    joint.covariance = Covariance(Eigen::Matrix3d(4e-4 * Eigen::Matrix3d::Identity()));
  }
  return body;
}

Prop box() {
  return {.name = "box", .joint = HandLeft, .other = HandRight, .size = {0.3, 0.2, 0.3}};
}

TEST(AProp, IsInTheMiddleOfBothHandsAndTurnsWithTheForearms) {
  for (const double yaw : {0.0, 0.7, -2.9}) {
    const Vector3d at(1.0, 0.0, -2.0);
    const auto pose = grip_of(carrying(at, yaw), box());
    ASSERT_TRUE(pose);
    EXPECT_THAT(pose->world_from_prop.translation(),
                VectorNear(at + about_y(yaw) * Vector3d(0, 1.1, 0.42), 1e-9));
    EXPECT_LT(angular_distance(Eigen::Quaterniond(pose->world_from_prop.linear()), about_y(yaw)),
              1e-6);
    EXPECT_NEAR(pose->sigma, 0.02 / std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(pose->turn_sigma, 0.02 * std::sqrt(2.0) / 0.3, 1e-6);
  }
}

TEST(AProp, OfOneHandLiesAlongTheForearmWithItsOffset) {
  Prop driver{
      .name = "driver", .joint = HandRight, .other = {}, .offset = {0, 0, 0.1}, .yaw = deg(90)};
  const auto body = carrying();
  HeldProp held(driver);
  const auto pose = held.follow(kStart, body);
  ASSERT_TRUE(pose);
  EXPECT_THAT(pose->world_from_prop.translation(), VectorNear(Vector3d(-0.15, 1.1, 0.52), 1e-9));
  EXPECT_THAT(Vector3d(pose->world_from_prop.linear() * Vector3d::UnitZ()),
              VectorNear(Vector3d::UnitX(), 1e-9));
  driver.joint = Head;
  Skeleton<WorldSpace> looking = carrying();
  looking[Head].orientation = about_y(0.4);
  EXPECT_LT(angular_distance(Eigen::Quaterniond(grip_of(looking, driver)->world_from_prop.linear()),
                             about_y(0.4)),
            1e-9);
}

TEST(AProp, ThatIsLevelStaysUprightWhereForearmsPointDown) {
  Skeleton<WorldSpace> body = carrying();
  for (const JointId elbow : {ElbowLeft, ElbowRight}) body[elbow].position.y() = 1.4;
  Prop prop = box();
  const auto turned = grip_of(body, prop);
  prop.level = true;
  const auto level = grip_of(body, prop);
  ASSERT_TRUE(turned && level);
  EXPECT_LT(turned->world_from_prop.linear()(1, 1), 0.9);
  EXPECT_NEAR(level->world_from_prop.linear()(1, 1), 1.0, 1e-9);
}

TEST(AProp, ThatIsLevelStaysUprightBetweenALowerAndAnUpperHand) {
  Skeleton<WorldSpace> body = carrying();
  for (const JointId id : {ElbowLeft, WristLeft, HandLeft}) body[id].position.y() += 0.2;
  Prop prop = box();
  EXPECT_LT(grip_of(body, prop)->world_from_prop.linear()(1, 1), 0.9);
  prop.level = true;
  const auto level = grip_of(body, prop);
  ASSERT_TRUE(level);
  EXPECT_TRUE(level->world_from_prop.linear().isIdentity(1e-9));
  EXPECT_NEAR(level->world_from_prop.linear().determinant(), 1.0, 1e-9);
  body[HandLeft].position.x() = body[HandRight].position.x();  // one right above the other
  ASSERT_TRUE(grip_of(body, prop));
  EXPECT_TRUE(grip_of(body, prop)->world_from_prop.matrix().allFinite());
}

TEST(AProp, IsNowhereWithoutItsJoints) {
  Skeleton<WorldSpace> body = carrying();
  body[HandLeft].state = JointState::NotTracked;
  EXPECT_FALSE(grip_of(body, box()));
  EXPECT_FALSE(HeldProp(box()).follow(kStart, body));
  body = carrying();
  body[HandLeft].position = body[HandRight].position;
  EXPECT_FALSE(grip_of(body, box()));
}

/// The hidden hand drifts away by `drift` within half a second, as a carried joint may.
TEST(AProp, DoesNotJumpWhenOneHandIsHidden) {
  HeldProp held(box());
  Vector3d before = Vector3d::Zero();
  double farthest = 0.0;
  double worst = 0.0;
  for (int i = 0; i < 90; ++i) {
    const Vector3d at(0.01 * i, 0.0, 0.0);
    Skeleton<WorldSpace> body = carrying(at);
    const bool hidden = i >= 40 && i < 55;
    if (hidden) {
      body[HandLeft].state = JointState::Inferred;
      body[HandLeft].position += Vector3d(0, -0.02 * (i - 39), 0);
    }
    const auto pose = held.follow(kStart + i * kFrameInterval, body);
    ASSERT_TRUE(pose) << i;
    const Vector3d place = pose->world_from_prop.translation();
    worst = std::max(worst, (place - at - Vector3d(0, 1.1, 0.42)).norm());
    if (i > 0) farthest = std::max(farthest, (place - before).norm());
    before = place;
  }
  EXPECT_LT(worst, 0.005);
  EXPECT_LT(farthest, 0.015);
}

TEST(AProp, TakesBackWhatTheOtherHandErredByLittleByLittle) {
  HeldProp held(box());
  Vector3d before = Vector3d::Zero();
  for (int i = 0; i < 120; ++i) {
    Skeleton<WorldSpace> body = carrying();
    if (i >= 30 && i < 60) body[HandLeft].state = JointState::NotTracked;
    if (i >= 30) {  // meanwhile the box was carried on with both hands, the right one askew
      for (const JointId id : {WristLeft, HandLeft}) body[id].position += Vector3d(0, 0.2, 0);
    }
    const auto pose = held.follow(kStart + i * kFrameInterval, body);
    ASSERT_TRUE(pose);
    const Vector3d place = pose->world_from_prop.translation();
    if (i > 0) {
      EXPECT_LT((place - before).norm(), 0.03) << i;
    }
    before = place;
  }
  EXPECT_THAT(before, VectorNear(Vector3d(0, 1.2, 0.42), 0.01));
}

TEST(AProp, KeepsTheHandsApartAsFarAsTheyWere) {
  HeldProp held(box());
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(held.follow(kStart + i * kFrameInterval, carrying()));
  Skeleton<WorldSpace> body = carrying();
  body[HandLeft].position.x() += 0.10;  // a bad instant of one hand, which says so
  body[HandLeft].covariance = Covariance(Eigen::Matrix3d(36e-4 * Eigen::Matrix3d::Identity()));
  const auto pose = held.follow(kStart + 60 * kFrameInterval, body);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->world_from_prop.translation().x(), 0.0, 0.015);  // without it 0.05
}

TEST(PropBoard, SaysWhoHoldsWhatAndWhatThereIs) {
  auto board =
      std::make_shared<PropBoard>(std::vector<Prop>{box(), {.name = "driver", .other = {}}});
  const auto wrong = board->take_up("bax", 1);
  ASSERT_FALSE(wrong);
  EXPECT_THAT(to_string(wrong.error()), ::testing::HasSubstr("box, driver"));
  HeldProps props(board);
  const auto body = carrying();
  EXPECT_FALSE(props.follow(kStart, {{7, &body}})[0].tracked);
  ASSERT_TRUE(board->take_up("box", 7));
  const auto held = props.follow(kStart + kFrameInterval, {{7, &body}});
  EXPECT_TRUE(held[0].tracked);
  EXPECT_FALSE(held[1].pose);
  ASSERT_TRUE(board->put_down("box"));
  const auto moved = carrying({1, 0, 0});
  const auto down = props.follow(kStart + 2 * kFrameInterval, {{7, &moved}});
  EXPECT_FALSE(down[0].tracked);
  EXPECT_FALSE(down[0].holding.person);
  ASSERT_TRUE(down[0].pose);  // it lies where it was put down
  EXPECT_NEAR(down[0].pose->world_from_prop.translation().x(), 0.0, 1e-9);
  EXPECT_FALSE(props.follow(kStart + 3 * kFrameInterval, {})[0].tracked);
}

std::string trouble_of(const std::string& props) {
  auto root = ConfigReader::parse("{\"props\": [" + props + "]}", "test").value();
  (void)read_props(root);
  const auto ok = root.finish();
  return ok ? "" : to_string(ok.error());
}

TEST(PropSettings, AreReadAndMistakesAreTold) {
  auto root = ConfigReader::parse(R"({"props": [{"name": "box", "joints": ["HandLeft", "HandRight"],
      "offset_m": [0, 0.1, 0], "yaw_deg": 90, "size_m": [0.3, 0.2, 0.3], "level": true}]})",
                                  "test")
                  .value();
  const auto props = read_props(root);
  ASSERT_TRUE(root.finish());
  ASSERT_EQ(props.size(), 1u);
  EXPECT_EQ(props[0].other, HandRight);
  EXPECT_NEAR(props[0].yaw, deg(90), 1e-9);
  EXPECT_TRUE(props[0].level);
  using ::testing::HasSubstr;
  EXPECT_THAT(trouble_of(R"({"name": "a b"})"), HasSubstr("letters"));
  EXPECT_THAT(trouble_of(R"({"name": "Body0"})"), HasSubstr("Body"));
  EXPECT_THAT(trouble_of(R"({"name": "a", "joints": ["Hand"]})"), HasSubstr("HandRight"));
  EXPECT_THAT(trouble_of(R"({"name": "a", "joints": []})"), HasSubstr("one joint, or two"));
  EXPECT_THAT(trouble_of(R"({"name": "a", "offset_m": [1, 2]})"), HasSubstr("three numbers"));
  EXPECT_THAT(trouble_of(R"({"name": "a"}, {"name": "a"})"), HasSubstr("twice"));
}

}  // namespace
}  // namespace chorus::workplace
