// People in the slots where they are seated; every joint gets an orientation; velocities follow
// from the previous frame.
#include "fusion-server/outlet/tracker_frame.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::outlet {
namespace {

using std::chrono::milliseconds;
using testing::kStart;
using testing::VectorNear;

FusedBody person(std::uint64_t id, double x = 0.0) {
  FusedBody body;
  body.id = {id};
  body.slot = 0;
  body.skeleton = testing::standing_person({x, 0, 0});
  return body;
}

FusedBody seated(std::uint64_t id, std::size_t slot) {
  FusedBody body = person(id);
  body.slot = slot;
  return body;
}

Snapshot snapshot(Duration after, std::vector<FusedBody> bodies) {
  Snapshot s;
  s.sequence = 9;
  s.instant = kStart + after;
  s.bodies = std::move(bodies);
  return s;
}

std::vector<std::pair<std::size_t, std::uint64_t>> slots(const TrackerFrame& frame) {
  std::vector<std::pair<std::size_t, std::uint64_t>> out;
  for (const TrackerBody& body : frame.bodies) out.emplace_back(body.slot, body.person.value);
  return out;
}

using Slots = std::vector<std::pair<std::size_t, std::uint64_t>>;

TEST(TrackerSlots, AreThoseOfTheSnapshotInOrder) {
  TrackerState state(4);
  EXPECT_EQ(slots(state.advance(snapshot(milliseconds(0), {seated(7, 3), seated(4, 1)}))),
            (Slots{{1, 4}, {3, 7}}));
  EXPECT_EQ(slots(state.advance(snapshot(milliseconds(33), {seated(7, 0)}))), (Slots{{0, 7}}));
}

TEST(TrackerSlots, WhoHasNoneOrOneBeyondTheLastIsLeftOut) {
  TrackerState state(2);
  FusedBody unseated = person(5);
  unseated.slot.reset();
  EXPECT_EQ(slots(state.advance(
                snapshot(milliseconds(0), {seated(4, 1), unseated, seated(6, 2), seated(7, 63)}))),
            (Slots{{1, 4}}));
}

TEST(TrackerJoints, AnUnseenOneHangsAtTheNextTrackedOneTowardsThePelvis) {
  FusedBody body = person(1);
  testing::hide(body.skeleton[JointId::HandLeft]);
  testing::hide(body.skeleton[JointId::WristLeft]);
  TrackerState state(1);
  const TrackerBody sent = state.advance(snapshot(milliseconds(0), {body})).bodies.at(0);
  EXPECT_EQ(nearest_tracked(sent, JointId::HandLeft), JointId::ElbowLeft);
  EXPECT_EQ(nearest_tracked(sent, JointId::Head), JointId::Head);
  EXPECT_EQ(nearest_tracked(TrackerBody{}, JointId::Head), JointId::SpineBase);
}

TEST(TrackerJoints, OfLimbsWithASensorHaveTheirTwistIfItIsKnownWell) {
  FusedBody body = person(1);
  const std::size_t elbow = index_of(JointId::ElbowLeft);
  const std::size_t knee = index_of(JointId::KneeLeft);
  body.skeleton.joints[elbow].orientation = body.skeleton.joints[knee].orientation =
      Eigen::Quaterniond(Eigen::AngleAxisd(deg(90), Eigen::Vector3d::UnitZ()));  // bone along -x
  const auto turns = [](double about_x, double others) {
    const Eigen::Matrix3d squares =
        Eigen::Vector3d(about_x, others, others).cwiseAbs2().asDiagonal();
    return Covariance(squares);
  };
  body.orientation_covariance[elbow] = turns(deg(10), deg(80));
  body.orientation_covariance[knee] = turns(deg(40), deg(1));
  TrackerState state(1);
  const TrackerBody sent = state.advance(snapshot(milliseconds(0), {body})).bodies.at(0);
  EXPECT_TRUE(sent[JointId::ElbowLeft].twist_measured);
  EXPECT_FALSE(sent[JointId::KneeLeft].twist_measured);
  EXPECT_FALSE(sent[JointId::ElbowRight].twist_measured) << "no sensor";
}

TEST(TrackerJoints, WithoutAnOrientationTakeThatOfTheNextOneTowardsThePelvis) {
  FusedBody body = person(1);
  for (Joint& joint : body.skeleton.joints) joint.orientation.coeffs().setZero();
  const Eigen::Quaterniond wrist = about_y(deg(35));
  body.skeleton[JointId::WristLeft].orientation = wrist;
  TrackerState state(1);
  const TrackerFrame frame = state.advance(snapshot(milliseconds(0), {body}));
  const TrackerBody& sent = frame.bodies.at(0);
  EXPECT_LT(angular_distance(sent[JointId::HandTipLeft].orientation, wrist), 1e-9);
  EXPECT_LT(angular_distance(sent[JointId::Head].orientation, Eigen::Quaterniond::Identity()),
            1e-9);
}

TEST(TrackerJoints, UntrackedOnesSaySo) {
  FusedBody body = person(1);
  testing::hide(body.skeleton[JointId::FootLeft]);
  body.skeleton[JointId::FootRight].position.x() = std::nan("");
  TrackerState state(1);
  const TrackerFrame frame = state.advance(snapshot(milliseconds(0), {body}));
  EXPECT_FALSE(frame.bodies.at(0)[JointId::FootLeft].tracked);
  EXPECT_FALSE(frame.bodies.at(0)[JointId::FootRight].tracked);
  EXPECT_TRUE(frame.bodies.at(0)[JointId::Head].tracked);
}

TEST(TrackerVelocity, SettlesToThatOfAPersonWhoWalksEvenly) {
  TrackerState state(1);
  TrackerFrame frame;
  for (int i = 0; i < 12; ++i) {
    frame = state.advance(snapshot(milliseconds(40 * i), {person(1, 0.04 * i)}));
  }
  EXPECT_THAT(frame.bodies.at(0)[JointId::Head].velocity,
              VectorNear(Eigen::Vector3d(1.0, 0, 0), 0.01));
}

TEST(TrackerVelocity, IsZeroAcrossAGapAndForARepeatedInstant) {
  TrackerState state(1);
  (void)state.advance(snapshot(milliseconds(0), {person(1, 0.0)}));
  const TrackerFrame gap = state.advance(snapshot(milliseconds(2000), {person(1, 1.0)}));
  EXPECT_EQ(gap.bodies.at(0)[JointId::Head].velocity.norm(), 0.0);
  const TrackerFrame again = state.advance(snapshot(milliseconds(2000), {person(1, 2.0)}));
  EXPECT_EQ(again.bodies.at(0)[JointId::Head].velocity.norm(), 0.0);
}

TEST(TrackerVelocity, IsThatOfTheMethodIfItStatesOne) {
  TrackerState state(1);
  FusedBody body = person(1);
  body.motion.emplace();
  (*body.motion)[index_of(JointId::Head)].velocity = {0, 0, 0.7};
  for (int i = 0; i < 2; ++i) {
    const TrackerFrame frame = state.advance(snapshot(milliseconds(33 * i), {body}));
    EXPECT_EQ(frame.bodies.at(0)[JointId::Head].velocity.z(), 0.7) << i;
  }
}

TrackerFrame moving() {
  TrackerFrame frame;
  frame.instant = kStart;
  frame.bodies.resize(1);
  frame.bodies[0].joints[0].velocity = {2.0, 0, 0};
  frame.bodies[0].joints[0].angular_velocity = {0, deg(90), 0};
  return frame;
}

TEST(Prediction, MovesAndTurnsAtConstantVelocity) {
  const TrackerFrame then = predicted(moving(), {}, kStart + milliseconds(20));
  EXPECT_THAT(then.bodies[0].joints[0].position, VectorNear(Eigen::Vector3d(0.04, 0, 0), 1e-9));
  EXPECT_LT(angular_distance(then.bodies[0].joints[0].orientation, about_y(deg(1.8))), 1e-9);
  EXPECT_EQ(then.instant, kStart + milliseconds(20));
}

TEST(Prediction, IsTheMethodsOwnIfItStatesVelocities) {
  Snapshot now = snapshot(milliseconds(0), {person(1)});
  now.bodies[0].motion.emplace();
  for (JointMotion& motion : *now.bodies[0].motion) {
    motion.velocity = {0, 0, 1.0};
    motion.variance = 0.01;
  }
  TrackerState state(1);
  const TrackerFrame then = predicted(state.advance(now), now, kStart + milliseconds(50));
  const double way = then.bodies.at(0)[JointId::Head].position.z() -
                     now.bodies[0].skeleton[JointId::Head].position.z();
  EXPECT_NEAR(way, 0.047, 0.001) << "the speed fades";
}

TEST(Prediction, GoesNoFurtherThanFiftyMillisecondsAndNeverBack) {
  EXPECT_EQ(predicted(moving(), {}, kStart + std::chrono::seconds(3)).instant,
            kStart + milliseconds(50));
  EXPECT_EQ(predicted(moving(), {}, kStart - milliseconds(5)).instant, kStart);
}

TEST(TrackerProps, FollowTheHandsOfWhoeverHoldsThem) {
  auto board = std::make_shared<workplace::PropBoard>(
      std::vector<workplace::Prop>{{.name = "driver", .other = {}}, {.name = "lamp", .other = {}}});
  TrackerState state(4, board);
  ASSERT_TRUE(board->take_up("driver", 7));
  (void)state.advance(snapshot(milliseconds(0), {seated(7, 3)}));
  FusedBody moved = seated(7, 3);
  moved.skeleton = testing::standing_person({0.1, 0, 0});
  const Snapshot next = snapshot(milliseconds(100), {moved});
  const TrackerFrame frame = state.advance(next);
  ASSERT_EQ(frame.props.size(), 2u);
  EXPECT_EQ(frame.props[0].name, "driver");
  EXPECT_EQ(frame.props[0].slot, 3u);
  EXPECT_TRUE(frame.props[0].pose.tracked);
  EXPECT_FALSE(frame.props[1].pose.tracked);
  const Eigen::Vector3d hand = moved.skeleton[JointId::HandRight].position;
  EXPECT_THAT(frame.props[0].pose.position, VectorNear(hand, 1e-9));
  EXPECT_THAT(frame.props[0].pose.velocity, VectorNear(Eigen::Vector3d(0.5, 0, 0), 1e-9));
  const TrackerFrame later = predicted(frame, next, next.instant + milliseconds(40));
  EXPECT_NEAR(later.props[0].pose.position.x(), hand.x() + 0.02, 1e-9);
  EXPECT_FALSE(state.advance(snapshot(milliseconds(133), {})).props[0].pose.tracked);
}

}  // namespace
}  // namespace chorus::outlet
