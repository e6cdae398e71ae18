// Where a track is expected: ahead along its motion, and on the floor only.
#include <string>

#include <gtest/gtest.h>

#include "fusion-server/associate/person_association.h"
#include "fusion-server/associate/track_motion.h"

namespace chorus::associate {
namespace {

constexpr Duration kMotionFrame = std::chrono::milliseconds(33);
constexpr double kFrameSeconds = 0.033;

SensorView view_at(const Eigen::Vector3d& place, int sensor = 1) {
  SensorView sight;
  sight.sensor = SensorId::parse("s" + std::to_string(sensor)).value();
  sight.body = BodyId{1};
  for (const JointId id : {JointId::SpineBase, JointId::Neck, JointId::Head}) {
    sight.skeleton[id].position = place + Eigen::Vector3d(0, 0.2 * static_cast<double>(id), 0);
    sight.skeleton[id].state = JointState::Tracked;
  }
  return sight;
}

/// Processes one instant after another; keeps the tracks.
struct Floor {
  Tracks tracks;
  Timestamp instant = from_unix_ns(1'790'000'000'000'000'000);

  std::vector<Person> see(std::vector<SensorView> views) {
    instant += kMotionFrame;
    Grouping grouping = group({instant, std::move(views)}, tracks, {});
    tracks = grouping.tracks;
    return grouping.people;
  }
  /// A person walks along x at `speed` [m/s]; returns x at the instant after the last one.
  double walk(double speed, int instants) {
    for (int i = 0; i < instants; ++i) see({view_at({speed * kFrameSeconds * i, 1, 0})});
    return speed * kFrameSeconds * instants;
  }
};

TEST(TrackMotion, SomebodyWhoWalksOnUnseenIsFoundAhead) {
  Floor floor;
  double x = floor.walk(2.5, 40);
  // For 0.33 s nobody is seen; meanwhile the person walks 0.83 m.
  for (int i = 0; i < 10; ++i, x += 2.5 * kFrameSeconds) floor.see({});
  const auto people = floor.see({view_at({x, 1, 0})});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, PersonId{1});
  EXPECT_EQ(floor.tracks.people.size(), 1u);
}

TEST(TrackMotion, SomebodyWhoWalkedIsNotLookedForWhereTheWalkBegan) {
  Floor floor;
  const double x = floor.walk(2.5, 40);
  for (int i = 0; i < 10; ++i) floor.see({});
  floor.see({view_at({x - 0.3, 1, 0})});  // 1.1 m behind the predicted place
  EXPECT_EQ(floor.tracks.people.size(), 2u);
}

TEST(TrackMotion, VelocityFollowsTheWalkAndIsNeverAbsurd) {
  Floor floor;
  floor.walk(1.2, 40);
  EXPECT_NEAR(floor.tracks.people.at(0).velocity.x(), 1.2, 0.05);
  Floor wild;
  wild.see({view_at({0, 1, 0})});
  wild.see({view_at({0.5, 1, 0})});  // 15 m/s
  wild.see({view_at({1.0, 1, 0})});
  EXPECT_LE(wild.tracks.people.at(0).velocity.norm(), 4.0 + 1e-9);
}

/// The person as a depth sensor shows them, and as a camera without depth does.
PlacedView by_depth(const Eigen::Vector3d& place) { return {view_at(place), place}; }
PlacedView by_rays(const Eigen::Vector3d& place) {
  PlacedView sight{view_at(place, 2)};
  sight.view.eye = {0, 1.4, -3.5};
  for (Joint& joint : sight.view.skeleton.joints) {
    if (!joint.seen()) continue;
    joint.position = (joint.position - sight.view.eye).normalized();
    joint.measurement = Measurement::Ray;
  }
  sight.rays = true;
  return sight;
}

TEST(TrackMotion, WhomACameraAloneHasFollowedIsPlacedAgainWithoutALeapOfSpeed) {
  Track track;
  Timestamp instant = from_unix_ns(1'790'000'000'000'000'000);
  Eigen::Vector3d place(-1, 1, 0);
  const auto see = [&](std::vector<PlacedView> sights) {
    instant += kMotionFrame;
    place.x() += kFrameSeconds;  // 1 m/s
    Candidate candidate = predict(track, instant, {});
    for (PlacedView& each : sights) candidate.sights.push_back(std::move(each));
    update(candidate, instant);
    track = candidate.track;
  };
  const auto next = [&] {
    return Eigen::Vector3d(place + kFrameSeconds * Eigen::Vector3d::UnitX());
  };
  for (int i = 0; i < 40; ++i) see({by_depth(next()), by_rays(next())});
  for (int i = 0; i < 30; ++i) see({by_rays(next())});
  ASSERT_EQ(track.seen, instant);
  ASSERT_EQ(instant - track.placed, 30 * kMotionFrame);
  EXPECT_NEAR(track.velocity.x(), 1.0, 0.2);
  see({by_depth(next()), by_rays(next())});
  EXPECT_NEAR(track.velocity.x(), 1.0, 0.2) << "the way of a second is no way of a frame";
}

TEST(TrackMotion, HeightDoesNotSeparateAPersonFromItsTrack) {
  Floor floor;
  floor.walk(0.0, 5);
  SensorView head_only = view_at({0.1, 1, 0}, 2);  // hip and neck hidden: 0.9 m higher
  head_only.skeleton[JointId::SpineBase].state = JointState::NotTracked;
  head_only.skeleton[JointId::Neck].state = JointState::NotTracked;
  head_only.skeleton[JointId::Head].position.y() = 1.9;
  const auto people = floor.see({view_at({0, 1, 0}), head_only});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].views.size(), 2u);
  EXPECT_EQ(floor.tracks.people.size(), 1u);
}

TEST(TrackMotion, NewcomersSeenInPartsAreOnePerson) {
  Floor floor;
  SensorView legs = view_at({0.1, 1, 0}, 2);
  legs.skeleton[JointId::Neck].state = legs.skeleton[JointId::Head].state = JointState::NotTracked;
  legs.skeleton[JointId::SpineBase].position.y() = 0.6;
  floor.see({view_at({0, 1.2, 0}), legs});
  EXPECT_EQ(floor.tracks.people.size(), 1u);
}

TEST(TrackMotion, AViewThatComesAndGoesFakesNoSpeed) {
  Floor floor;
  for (int i = 0; i < 60; ++i) {
    std::vector<SensorView> views{view_at({0, 1, 0})};
    if (i % 2 == 0) views.push_back(view_at({0.3, 1, 0}, 2));  // sensor 2 is registered 0.3 m off
    floor.see(views);
    EXPECT_LT(floor.tracks.people.at(0).velocity.norm(), 1e-9) << i;
  }
}

TEST(TrackMotion, WhoIsNotSeenSlowsDownAndIsLookedForFartherAway) {
  AssociationConfig config;
  Track track;
  track.velocity = {1.0, 0, 0};
  const Candidate soon = predict(track, Timestamp{} + std::chrono::milliseconds(100), config);
  const Candidate late = predict(track, Timestamp{} + std::chrono::seconds(3), config);
  EXPECT_NEAR(soon.predicted.x(), 0.1, 0.005);
  EXPECT_LT(late.predicted.x(), 2.0);
  EXPECT_GT(late.predicted.x(), 1.0);
  EXPECT_NEAR(late.gate - soon.gate, 2.9 * config.gate_growth, 1e-9);
}

}  // namespace
}  // namespace chorus::associate
