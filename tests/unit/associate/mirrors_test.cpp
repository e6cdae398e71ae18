// Which bodies are images in a mirror, and which are people who stand like one.
#include "fusion-server/associate/mirrors.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "common/body/bones.h"
#include "fusion-server/associate/person_association.h"
#include "tests/support/builders.h"

namespace chorus::associate {
namespace {

constexpr Duration kMirrorFrame = std::chrono::milliseconds(33);
const Mirror kWall{Eigen::Vector3d::UnitZ(), 1.0};  // z = 1

/// Somebody at (x, z) in a stride, the right arm up: no posture that is its own reflection.
Skeleton<WorldSpace> walker_at(double x, double z, double phase) {
  Skeleton<WorldSpace> body;
  const double stride = 0.25 * std::sin(phase);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const double height = 0.1 + 0.06 * static_cast<double>(i);
    body.joints[i].position = {x, height, z};
    body.joints[i].state = JointState::Tracked;
  }
  for (const MirrorPair& pair : kMirrorPairs) {
    body[pair.left].position += Eigen::Vector3d(0.2 + stride, 0.0, 0.1 + stride);
    body[pair.right].position = body[pair.left].position;
    body[pair.right].position += Eigen::Vector3d(-0.4 - 2.0 * stride, 0.3, -2.0 * stride);
  }
  return body;
}

/// What a tracker shows of the image of `body` in the wall.
Skeleton<WorldSpace> image_in_wall(const Skeleton<WorldSpace>& body) {
  Skeleton<WorldSpace> image = body;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    image[id].position = reflected(kWall, body[mirror(id)].position);
  }
  return image;
}

JointPairs one_pair(const Skeleton<WorldSpace>& person, const Skeleton<WorldSpace>& image) {
  JointPairs pairs;
  pairs.add(person, image, Sides::Exchanged);
  return pairs;
}

TEST(Mirrors, AreFoundFromOneBodyAndItsImage) {
  const auto body = walker_at(0.4, 0.1, 0.7);
  const auto found = one_pair(body, image_in_wall(body)).reflection();
  ASSERT_TRUE(found);
  EXPECT_LT(found->rms, 1e-9);
  EXPECT_NEAR(std::abs(found->mirror.normal.z()), 1.0, 1e-9);
  EXPECT_NEAR(std::abs(found->mirror.offset), 1.0, 1e-9);
}

TEST(Mirrors, DoNotShowSomebodyInAnotherPosture) {
  const auto found = one_pair(walker_at(0, 0, 0.7), walker_at(0, 2, 0.7)).reflection();
  ASSERT_TRUE(found);
  EXPECT_GT(found->rms, 0.15) << "the same posture is no reflection";
}

TEST(Mirrors, NeedJointsAndADistance) {
  const auto body = walker_at(0, 0, 0.7);
  EXPECT_FALSE(one_pair(body, body).reflection());
  Skeleton<WorldSpace> three = image_in_wall(body);
  for (std::size_t i = 3; i < kJointCount; ++i) three.joints[i].state = JointState::NotTracked;
  EXPECT_FALSE(one_pair(body, three).reflection());
  EXPECT_TRUE(std::isinf(JointPairs().distance(kWall)));
  Skeleton<WorldSpace> broken = image_in_wall(body);
  broken.joints[5].position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(one_pair(body, broken).reflection());
}

/// Two sensors at z = -3 look along +z, towards the wall.
struct RoomWithMirror {
  std::vector<Observer> observers;
  Tracks tracks = {};
  Timestamp instant = testing::kStart;
  std::vector<Standing> standings = {};

  RoomWithMirror() {
    for (const double x : {-0.5, 0.5}) {
      Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
      place.translation() = Eigen::Vector3d(x, 1.2, -3.0);
      observers.push_back({testing::sensor_id(x < 0 ? "s1" : "s2"), place});
    }
  }

  /// The bodies as both sensors see them.
  std::vector<Person> see(const std::vector<Skeleton<WorldSpace>>& bodies) {
    instant += kMirrorFrame;
    Scene scene{instant, {}, observers};
    for (const Observer& observer : observers) {
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        SensorView view;
        view.sensor = observer.sensor;
        view.body = BodyId{i + 1};
        view.skeleton = bodies[i];
        scene.views.push_back(std::move(view));
      }
    }
    Grouping grouping = group(std::move(scene), tracks, {});
    tracks = std::move(grouping.tracks);
    standings = std::move(grouping.standings);
    return std::move(grouping.people);
  }
};

TEST(Mirrors, ShowNobodyWhileThePersonWalks) {
  RoomWithMirror room;
  for (int i = 0; i < 60; ++i) {
    const auto body = walker_at(-0.6 + 0.02 * i, 0.1, 0.2 * i);
    EXPECT_LE(room.see({body, image_in_wall(body)}).size(), 1u) << i;
  }
  ASSERT_EQ(room.tracks.mirrors.size(), 1u);
  EXPECT_NEAR(std::abs(room.tracks.mirrors[0].offset), 1.0, 0.02);
  ASSERT_EQ(room.standings.size(), 2u);
  EXPECT_TRUE(room.standings[1].image);
  EXPECT_FALSE(room.standings[0].image) << "the person is on the sensors' side";
}

TEST(Mirrors, ThatAreKnownShowNobodyFromTheFirstInstantOn) {
  RoomWithMirror room;
  room.tracks.mirrors = {kWall};
  for (int i = 0; i < 30; ++i) {
    const auto body = walker_at(0.3, 0.1, 0.0);  // stands still
    EXPECT_LE(room.see({body, image_in_wall(body)}).size(), 1u) << i;
  }
}

TEST(Mirrors, ShowNobodyWhileThePersonIsUnseenForAWhile) {
  RoomWithMirror room;
  Skeleton<WorldSpace> image;
  for (int i = 0; i < 60; ++i) {
    const auto body = walker_at(-0.6 + 0.02 * i, 0.1, 0.2 * i);
    image = image_in_wall(body);
    room.see({body, image});
  }
  ASSERT_EQ(room.tracks.people.size(), 2u);
  const PersonId nobody = room.tracks.people[1].id;
  for (int i = 0; i < 60; ++i) {  // two seconds
    for (const Person& person : room.see({image})) EXPECT_NE(person.id, nobody) << i;
  }
}

TEST(Mirrors, TheOldestIsForgottenForANewOne) {
  RoomWithMirror room;
  for (int i = 0; i < 8; ++i) room.tracks.mirrors.push_back({Eigen::Vector3d::UnitX(), 20.0 + i});
  for (int i = 0; i < 60; ++i) {
    const auto body = walker_at(-0.6 + 0.02 * i, 0.1, 0.2 * i);
    room.see({body, image_in_wall(body)});
  }
  ASSERT_EQ(room.tracks.mirrors.size(), 8u);
  EXPECT_NEAR(room.tracks.mirrors.front().offset, 21.0, 1e-9);
  EXPECT_NEAR(std::abs(room.tracks.mirrors.back().offset), 1.0, 0.02);
}

TEST(Mirrors, AreNotBetweenTwoWhoWalkSideBySide) {
  RoomWithMirror room;
  std::size_t people = 0;
  for (int i = 0; i < 60; ++i) {
    const double x = -0.6 + 0.02 * i;
    people = room.see({walker_at(x, 0.1, 0.2 * i), walker_at(x, 1.1, 0.2 * i)}).size();
  }
  EXPECT_EQ(people, 2u);
  EXPECT_TRUE(room.tracks.mirrors.empty());
}

/// They do as a mirror would, but a sensor behind the plane sees the second one, too.
TEST(Mirrors, AreNotWhereSensorsOnBothSidesSeeTheBody) {
  RoomWithMirror room;
  room.observers[1].world_from_sensor =
      Eigen::Translation3d(0.5, 1.2, 5.0) *
      Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitY());
  std::size_t people = 0;
  for (int i = 0; i < 60; ++i) {
    const auto body = walker_at(-0.6 + 0.02 * i, 0.1, 0.2 * i);
    people = room.see({body, image_in_wall(body)}).size();
  }
  EXPECT_EQ(people, 2u);
}

}  // namespace
}  // namespace chorus::associate
