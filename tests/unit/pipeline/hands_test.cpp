// Hands that sensors tell joint by joint find the people whose they are.
#include "fusion-server/pipeline/hands.h"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/ring.h"

namespace chorus::pipeline {
namespace {

using std::chrono::milliseconds;

HandPoints hand_at(const Eigen::Vector3d& wrist, std::optional<double> variance = 1e-4) {
  HandPoints hand;
  for (std::size_t i = 0; i < kHandPoints; ++i)
    hand.points[i] = wrist + Eigen::Vector3d(0.005 * static_cast<double>(i), 0, 0);
  hand.variance = variance;
  return hand;
}

std::vector<FusedBody> two_people() {
  std::vector<FusedBody> bodies(2);
  bodies[0].skeleton = body_at(0, 0);
  bodies[1].skeleton = body_at(2, 0);
  return bodies;
}

Eigen::Vector3d wrist_of(const FusedBody& body, JointId id) { return body.skeleton[id].position; }

const Eigen::Vector3d kAside(0.0, 0.0, 0.1);

TEST(Hands, BelongToTheNearestWristOfTheirSide) {
  auto bodies = two_people();
  const Eigen::Vector3d left = wrist_of(bodies[1], JointId::WristLeft) + kAside;
  give_hands({{true, hand_at(left)}}, bodies);
  EXPECT_FALSE(bodies[0].hands);
  ASSERT_TRUE(bodies[1].hands);
  ASSERT_TRUE(bodies[1].hands->left);
  EXPECT_FALSE(bodies[1].hands->right);
  EXPECT_EQ(bodies[1].hands->left->wrist(), left) << "stands where its sensor places it";
}

TEST(Hands, FarFromEveryWristBelongToNobody) {
  auto bodies = two_people();
  const Eigen::Vector3d left = wrist_of(bodies[0], JointId::WristLeft);
  give_hands({{true, hand_at(left + Eigen::Vector3d(0, 0, 0.3))}}, bodies);
  EXPECT_FALSE(bodies[0].hands);
  bodies[0].carried_for = 0.5;
  give_hands({{true, hand_at(left)}}, bodies);
  EXPECT_FALSE(bodies[0].hands) << "a body that is only expected has no hands that are seen";
}

TEST(Hands, OfOneWristThatWithTheLeastVarianceCountsThenTheNearest) {
  auto bodies = two_people();
  const Eigen::Vector3d right = wrist_of(bodies[0], JointId::WristRight);
  give_hands({{false, hand_at(right, 1e-3)},
              {false, hand_at(right + kAside, 1e-4)},
              {false, hand_at(right, std::nullopt)}},
             bodies);
  EXPECT_EQ(bodies[0].hands->right->wrist(), right + kAside);
  give_hands({{false, hand_at(right + kAside, 1e-4)}, {false, hand_at(right, 1e-4)}}, bodies);
  EXPECT_EQ(bodies[0].hands->right->wrist(), right);
}

/// Beside a ring of six sensors a seventh that sees only the right hand of person 0, whose arm is
/// stretched so far that the hand's middle is no neighbour of the body's.
struct Glove {
  Histories histories = ring_histories({});
  Registration registration = ring_registration(6);
  SensorId name = SensorId::parse("glove").value();
  Eigen::Isometry3d place = ring_place(1, 5);

  explicit Glove(double off = 0.05) {
    registration.sensors[name].world_from_sensor = place;
    const Eigen::Isometry3d sensor_from_world = place.inverse();
    for (Duration t{0}; t < std::chrono::seconds(2); t += milliseconds(40)) {
      const auto truth = walker(0, seconds(t));
      const Eigen::Vector3d wrist =
          truth[JointId::WristRight].position + Eigen::Vector3d(off, 0, 0);
      BodyFrame hand{BodyId{1}, pipeline::kStart + t, {}};
      for (const JointId id : {JointId::WristRight, JointId::HandTipRight}) {
        hand.skeleton[id].position = sensor_from_world * wrist;
        hand.skeleton[id].state = JointState::Tracked;
      }
      hand.hands = shared({std::nullopt, moved(sensor_from_world, hand_at(wrist))});
      SensorFrame frame;
      frame.sensor = name;
      frame.captured = pipeline::kStart + t;
      frame.bodies.push_back(hand);
      histories[name].push(std::move(frame));
    }
  }

  Step run() const {
    PipelineConfig config;
    config.fusion.method = fusion::Method::InverseVariance;
    Step result;
    for (int i = 0; i < 30; ++i) {
      const Timestamp instant = pipeline::kStart + milliseconds(200 + 33 * i);
      result = step({instant, instant + milliseconds(80), static_cast<std::uint64_t>(i)}, histories,
                    registration, result.memory, config);
    }
    return result;
  }
};

TEST(Hands, OfASensorOfTheirOwnBecomeHandsOfThePersonAndNoPerson) {
  const Step last = Glove().run();
  ASSERT_EQ(last.snapshot.bodies.size(), 1u) << "a hand alone is nobody";
  const FusedBody& body = last.snapshot.bodies[0];
  ASSERT_TRUE(body.hands && body.hands->right);
  const Eigen::Vector3d wrist = wrist_of(body, JointId::WristRight);
  EXPECT_NEAR((body.hands->right->wrist() - wrist).norm(), 0.05, 0.002)
      << "at the instant itself, between two of the sensor's frames";
  EXPECT_NEAR(
      (body.hands->right->points[20] - body.hands->right->wrist() - Eigen::Vector3d(0.1, 0, 0))
          .norm(),
      0.0, 1e-6);
}

TEST(Hands, WithNobodyElseInSightStayABody) {
  Glove alone;
  for (auto it = alone.histories.begin(); it != alone.histories.end();)
    it = it->first == alone.name ? std::next(it) : alone.histories.erase(it);
  std::vector<AlignedSensor> aligned(1);
  aligned[0].sensor = alone.name;
  aligned[0].bodies = alone.histories.at(alone.name).frames().front().bodies;
  SensorView view;
  view.sensor = alone.name;
  view.body = BodyId{1};
  view.skeleton = to_world(alone.place, aligned[0].bodies[0].skeleton);
  std::vector<SensorView> views{view};
  leave_out_lone_hands(aligned, views);
  EXPECT_EQ(views.size(), 1u);
  SensorView person;
  person.sensor = sensor(1);
  person.skeleton = walker(0, 0.0);
  views.push_back(person);
  leave_out_lone_hands(aligned, views);
  ASSERT_EQ(views.size(), 1u);
  EXPECT_EQ(views[0].sensor, sensor(1));
}

}  // namespace
}  // namespace chorus::pipeline
