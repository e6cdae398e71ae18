// A body of which one camera is left.
#include "fusion-server/fusion/held_body.h"

#include <set>

#include <gtest/gtest.h>

#include "fusion-server/fusion/fuse.h"
#include "tests/support/builders.h"
#include "tests/unit/fusion/cameras.h"

namespace chorus::fusion {
namespace {

using std::chrono::milliseconds;

constexpr double kBetweenSights = 1.0 / 30.0;  // [s]
constexpr std::size_t kPelvis = index_of(JointId::SpineBase);

PlacedBody body_at(const Eigen::Vector3d& place) {
  const auto person = testing::standing_person(place);
  PlacedBody body;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    body[j] = {person.joints[j].position, 1e-4 * Eigen::Matrix3d::Identity(),
               person.joints[j].seen()};
  }
  return body;
}

/// What a camera shows of the body; `ratio`: how much too far away it guesses it, none: as rays.
RayView shown(int camera, const PlacedBody& body, std::optional<double> ratio) {
  RayView view{
      testing::sensor_id("cam" + std::to_string(camera)), camera_eye(1.6 * camera), {}, {}};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Eigen::Vector3d way = body[j].position - view.eye;
    if (!body[j].placed) continue;
    view.rays[j] = {way.normalized(), 1e-5 * Eigen::Matrix3d::Identity(), true};
    if (ratio) view.depth[j] = (1.0 + *ratio) * way.norm();
  }
  return view;
}

struct Held {
  HeldBody held{BodyModel{}};
  Eigen::Vector3d place = Eigen::Vector3d::Zero();

  void by_several(const Eigen::Vector3d& velocity, const std::optional<double>& ratio, int frames) {
    for (int i = 0; i < frames; ++i) {
      held.predict(kBetweenSights);
      place += kBetweenSights * velocity;
      held.take(body_at(place));
      if (ratio) held.compare(shown(1, body_at(place), ratio), body_at(place));
    }
  }
  /// The error of the pelvis afterwards, and its covariance.
  std::pair<Eigen::Vector3d, Eigen::Matrix3d> by_one(const Eigen::Vector3d& velocity,
                                                     const std::optional<double>& ratio,
                                                     int frames) {
    std::optional<PlacedBody> found;
    for (int i = 0; i < frames; ++i) {
      held.predict(kBetweenSights);
      place += kBetweenSights * velocity;
      found = held.follow(shown(1, body_at(place), ratio));
    }
    if (!found) return {Eigen::Vector3d::Constant(1e9), Eigen::Matrix3d::Zero()};
    return {(*found)[kPelvis].position - body_at(place)[kPelvis].position,
            (*found)[kPelvis].covariance};
  }
};

TEST(HeldBody, OneCameraMovesItAcrossItsRay) {
  Held room;
  room.by_several({0, 0, 0}, std::nullopt, 30);
  // Camera 1 stands at an angle of 1.6 rad: it looks nearly along x.
  const auto [error, covariance] = room.by_one({0, 0, 0.6}, std::nullopt, 60);
  EXPECT_LT(error.norm(), 0.08);
  const Eigen::Vector3d sight = (room.place - camera_eye(1.6)).normalized();
  const Eigen::Vector3d side = sight.cross(Eigen::Vector3d::UnitY());
  EXPECT_GT(sight.dot(covariance * sight), 9.0 * side.dot(covariance * side))
      << "how far away it is stays open";
}

TEST(HeldBody, DepthFollowsSize) {
  Held room;
  room.by_several({0, 0, 0}, std::nullopt, 30);
  const auto [error, covariance] = room.by_one({0.7, 0, 0}, std::nullopt, 60);
  EXPECT_LT(error.norm(), 0.35) << "of 1.4 m";
  EXPECT_LT(error.dot(covariance.inverse() * error), 7.8) << "and it says so";
}

TEST(HeldBody, AGuessOfDepthDoesNotMoveWhoIsHeld) {
  Held room;
  room.by_several({0, 0, 0}, 0.1, 30);
  EXPECT_LT(room.by_one({0, 0, 0}, 0.1, 1).first.norm(), 0.02) << "0.1 of 3 m is 0.3 m";
  EXPECT_LT(room.by_one({0, 0, 0}, 0.1, 60).first.norm(), 0.05);
}

TEST(HeldBody, StatesMoreTheLongerOneCameraIsLeft) {
  Held room;
  room.by_several({0, 0, 0}, std::nullopt, 30);
  const double soon = room.by_one({0, 0, 0}, std::nullopt, 3).second.trace();
  const double late = room.by_one({0, 0, 0}, std::nullopt, 57).second.trace();
  EXPECT_GT(late, 2.0 * soon);
}

TEST(HeldBody, AGapMakesItAsUncertainAsItsInstantsTogether) {
  Held gap;
  Held instants;
  for (Held* each : {&gap, &instants}) each->by_several({0.4, 0, 0}, 0.05, 30);
  gap.held.predict(2.0 - kBetweenSights);
  for (int i = 0; i < 59; ++i) instants.held.predict(kBetweenSights);
  const auto [error, covariance] = gap.by_one({0, 0, 0}, std::nullopt, 1);
  const auto [same_error, same] = instants.by_one({0, 0, 0}, std::nullopt, 1);
  EXPECT_GT(same.trace(), 0.01);
  EXPECT_NEAR(covariance.trace(), same.trace(), 1e-6);
  EXPECT_NEAR((error - same_error).norm(), 0.0, 1e-6);
}

TEST(HeldBody, NothingIsHeldOfWhomSeveralHaveNotSeen) {
  HeldBody held{BodyModel{}};
  held.predict(kBetweenSights);
  EXPECT_FALSE(held.follow(shown(1, body_at({0, 0, 0}), std::nullopt)));
  EXPECT_FALSE(held.follow(shown(1, body_at({0, 0, 0}), 0.0)))
      << "without lengths a guess is what it was";
  EXPECT_FALSE(held.follow(RayView{}));
}

/// One person before four cameras, of which some see them.
struct OneLeftRoom {
  FusedBody see(const Eigen::Vector3d& place, std::initializer_list<int> cameras) {
    Person person{PersonId{1}, {}};
    std::vector<SensorId> sensors;
    for (int camera = 0; camera < 4; ++camera)
      sensors.push_back(testing::sensor_id("cam" + std::to_string(camera)));
    for (const int camera : cameras) {
      SensorView& view = person.views.emplace_back();
      view.sensor = sensors[static_cast<std::size_t>(camera)];
      view.eye = camera_eye(1.6 * camera);
      view.skeleton = testing::standing_person(place);
      if (depth.contains(camera)) continue;
      for (Joint& joint : view.skeleton.joints) {
        joint.position = (joint.position - view.eye).normalized();
        joint.measurement = Measurement::Ray;
      }
    }
    instant += milliseconds(33);
    return memory.fuse({person}, {instant, sensors}, {})[0];
  }
  std::set<int> depth;  ///< These measure depth.
  Memory memory;
  Timestamp instant = from_unix_ns(1'795'246'200'000'000'000);
};

TEST(OneCameraLeft, TheBodyIsHandedBackWithoutALeap) {
  OneLeftRoom room;
  Eigen::Vector3d place(0, 0, 0);
  for (int i = 0; i < 30; ++i) (void)room.see(place, {0, 1, 2, 3});
  FusedBody body;
  for (int i = 0; i < 30; ++i) body = room.see(place += Eigen::Vector3d(0.04, 0, 0), {1});
  ASSERT_TRUE(body.skeleton[JointId::Neck].seen());
  EXPECT_EQ(body.skeleton[JointId::Neck].state, JointState::Inferred);
  EXPECT_EQ(body.contributors[index_of(JointId::Neck)], 0b10U);
  const auto off = [&] {
    return Eigen::Vector3d(body.skeleton[JointId::Neck].position -
                           testing::standing_person(place)[JointId::Neck].position);
  };
  const Eigen::Vector3d before = off();
  ASSERT_GT(before.norm(), 0.05) << "somebody who walks away at 1.2 m/s";
  body = room.see(place, {0, 1, 2, 3});
  EXPECT_GT(off().norm(), 0.4 * before.norm()) << "but not at once";
  EXPECT_LT(off().dot(body.skeleton[JointId::Neck].covariance.matrix().inverse() * off()), 7.8)
      << "what is not yet handed back is stated";
  for (int i = 0; i < 30; ++i) body = room.see(place, {0, 1, 2, 3});
  EXPECT_LT(off().norm(), 0.01);
}

TEST(OneCameraLeft, OfDepthSensorsMovesWhomTheyPlaced) {
  OneLeftRoom room;
  room.depth = {0, 2, 3};
  Eigen::Vector3d place(0, 0, 0);
  FusedBody body;
  for (int i = 0; i < 60; ++i) body = room.see(place, {0, 1, 2, 3});
  ASSERT_EQ(body.method, "body-filter");
  const auto off = [&] {
    return Eigen::Vector3d(body.skeleton[JointId::Neck].position -
                           testing::standing_person(place)[JointId::Neck].position);
  };
  // Camera 1 looks nearly along x.
  for (int i = 0; i < 30; ++i) body = room.see(place += Eigen::Vector3d(0.01, 0, 0.02), {1});
  EXPECT_EQ(body.method, "points-and-rays");
  ASSERT_TRUE(body.skeleton[JointId::Neck].seen());
  EXPECT_LT(std::abs(off().z()), 0.06) << "of 0.6 m across";
  EXPECT_LT(off().norm(), 0.25);
  EXPECT_LT(off().dot(body.skeleton[JointId::Neck].covariance.matrix().inverse() * off()), 7.8);
  const Eigen::Vector3d before = off();
  ASSERT_GT(before.norm(), 0.03);
  body = room.see(place, {0, 1, 2, 3});
  EXPECT_EQ(body.method, "body-filter");
  EXPECT_LT((off() - before).norm(), 0.5 * before.norm()) << "handed back without a leap";
  for (int i = 0; i < 30; ++i) body = room.see(place, {0, 1, 2, 3});
  EXPECT_LT(off().norm(), 0.02);
}

}  // namespace
}  // namespace chorus::fusion
