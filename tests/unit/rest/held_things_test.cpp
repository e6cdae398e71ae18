// What people hold is in the snapshots, also in those that are fused again.
#include "fusion-server/rest/held_things.h"

#include <gtest/gtest.h>

#include "fusion-server/wire/snapshot_resource.h"
#include "tests/unit/rest/asked.h"

namespace chorus::rest {
namespace {

struct Hall {
  std::shared_ptr<workplace::PropBoard> board = std::make_shared<workplace::PropBoard>(
      std::vector<workplace::Prop>{{.name = "driver", .other = {}}, {.name = "box", .other = {}}});
  HeldThings things{board};

  Snapshot at(std::uint64_t sequence) {
    Snapshot shot = *snapshot(sequence);
    things.put(shot);
    return shot;
  }
};

TEST(HeldThings, AreThoseThatSomebodyInSightHolds) {
  Hall hall;
  EXPECT_TRUE(hall.at(1).held.empty());
  ASSERT_TRUE(hall.board->take_up("driver", 7));
  ASSERT_TRUE(hall.board->take_up("box", 99));
  const Snapshot shot = hall.at(2);
  ASSERT_EQ(shot.held.size(), 1u) << "nobody sees person 99";
  EXPECT_EQ(shot.held[0].name, "driver");
  EXPECT_EQ(shot.held[0].holder, PersonId{7});
  const Eigen::Vector3d hand = shot.bodies.at(0).skeleton[JointId::HandRight].position;
  EXPECT_LT((shot.held[0].world_from_thing.translation() - hand).norm(), 1e-9);
  const auto frame = wire::to_resource(shot);
  ASSERT_EQ(frame.props.size(), 1u);
  EXPECT_EQ(frame.props[0].holder, 7u);
  EXPECT_LT((frame.props[0].position - hand).norm(), 1e-9);
  ASSERT_TRUE(hall.board->put_down("driver"));
  EXPECT_TRUE(hall.at(3).held.empty());
}

TEST(HeldThings, AreThereAgainWhenTheInstantIsFusedAgain) {
  Hall hall;
  ASSERT_TRUE(hall.board->take_up("driver", 7));
  (void)hall.at(1);
  ASSERT_TRUE(hall.board->put_down("driver"));
  (void)hall.at(2);
  EXPECT_EQ(hall.things.again(*snapshot(1)).held.size(), 1u);
  EXPECT_TRUE(hall.things.again(*snapshot(2)).held.empty());
  EXPECT_TRUE(hall.things.again(*snapshot(9)).held.empty()) << "never published";
}

TEST(HeldThings, HandsMoveWithTheirWrists) {
  FusedBody then = snapshot(1)->bodies.at(0);
  FusedBody now = then;
  EXPECT_FALSE(hands_along(then, now));
  HandPoints hand;
  hand.points[20] = {1.0, 1.0, 1.0};
  then.hands = shared({hand, hand});
  now.skeleton[JointId::WristLeft].position += Eigen::Vector3d(0, 0.2, 0);
  now.skeleton[JointId::WristRight] = {};
  const HandsPtr moved = hands_along(then, now);
  ASSERT_TRUE(moved && moved->left && moved->right);
  EXPECT_NEAR(moved->left->points[20].y(), 1.2, 1e-12);
  EXPECT_EQ(moved->right->points[20].y(), 1.0) << "nobody knows where the wrist is then";
}

TEST(HeldThings, MoveWithTheJointsThatHoldThem) {
  FusedBody then = snapshot(1)->bodies.at(0);
  FusedBody now = then;
  now.skeleton[JointId::HandRight].position += Eigen::Vector3d(0.3, 0, 0);
  HeldThing thing{"driver", then.id, {JointId::HandRight}};
  EXPECT_NEAR(carried_along(thing, then, now).world_from_thing.translation().x(), 0.3, 1e-12);
  thing.joints.push_back(JointId::HandLeft);
  EXPECT_NEAR(carried_along(thing, then, now).world_from_thing.translation().x(), 0.15, 1e-12);
  now.skeleton[JointId::HandRight] = {};
  now.skeleton[JointId::HandLeft] = {};
  EXPECT_EQ(carried_along(thing, then, now).world_from_thing.translation().x(), 0.0);
}

}  // namespace
}  // namespace chorus::rest
