// People seen only by cameras without depth.
#include "fusion-server/associate/ray_matching.h"

#include <ctime>

#include <gtest/gtest.h>

#include "fusion-server/associate/person_association.h"
#include "tests/support/builders.h"

namespace chorus::associate {
namespace {

using testing::kFrameInterval;
using testing::kStart;
using testing::standing_person;

struct Camera {
  int number;
  Eigen::Vector3d eye;
};

const std::vector<Camera> kTwo{{1, {0, 1.4, -3.5}}, {2, {3.5, 1.6, 0.3}}};
const std::vector<Camera> kFour{
    {1, {0, 1.4, -3.5}}, {2, {3.5, 1.6, 0.3}}, {3, {0.4, 1.5, 3.5}}, {4, {-3.5, 1.3, 0}}};

SensorView seen_by(const Camera& camera, const Skeleton<WorldSpace>& person, std::uint64_t body) {
  SensorView view;
  view.sensor = testing::sensor_id("cam" + std::to_string(camera.number));
  view.body = BodyId{body};
  view.eye = camera.eye;
  view.skeleton = person;
  for (Joint& joint : view.skeleton.joints) {
    joint.position = (joint.position - camera.eye).normalized();
    joint.measurement = Measurement::Ray;
  }
  return view;
}

struct RayRoom {
  Tracks tracks;
  Timestamp instant = kStart;

  std::vector<Person> see(std::vector<SensorView> views) {
    instant += kFrameInterval;
    Grouping grouping = group({instant, std::move(views)}, tracks, {});
    tracks = grouping.tracks;
    return grouping.people;
  }
  /// Each camera numbers the bodies in its own order.
  std::vector<Person> see(const std::vector<Camera>& cameras,
                          const std::vector<Skeleton<WorldSpace>>& people) {
    std::vector<SensorView> views;
    for (const Camera& camera : cameras) {
      for (std::size_t i = 0; i < people.size(); ++i) {
        const std::size_t turned = (i + static_cast<std::size_t>(camera.number)) % people.size();
        views.push_back(seen_by(camera, people[turned], i));
      }
    }
    return see(std::move(views));
  }
};

Eigen::Vector3d core_of_track(const RayRoom& room, std::size_t i) {
  return room.tracks.people[i].core;
}

TEST(Locate, PutsAJointInTheMiddleOfItsPointsAndAsksNoRays) {
  PlacedView left;
  PlacedView right;
  PlacedView ray;
  left.view.skeleton = standing_person({0.1, 0, 0});
  right.view.skeleton = standing_person({0.3, 0, 0});
  ray.view = seen_by(kTwo[0], standing_person({2.0, 0, 0}), 1);
  const Located body = locate({left, ray, right});
  const Eigen::Vector3d neck = standing_person({0.2, 0, 0})[JointId::Neck].position;
  ASSERT_TRUE(body[static_cast<std::size_t>(JointId::Neck)]);
  EXPECT_LT((*body[static_cast<std::size_t>(JointId::Neck)] - neck).norm(), 1e-12);
}

TEST(RayMatching, TwoCamerasMakeOnePersonAtItsPlace) {
  RayRoom room;
  std::vector<Person> people;
  for (int i = 0; i < 3; ++i) people = room.see(kTwo, {standing_person({0.4, 0, 0.2})});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].views.size(), 2u);
  EXPECT_NEAR(core_of_track(room, 0).x(), 0.4, 0.05);
  EXPECT_NEAR(core_of_track(room, 0).z(), 0.2, 0.05);
  EXPECT_TRUE(people[0].views[0].skeleton[JointId::Neck].bears()) << "they stay rays";
}

/// The person with these joints alone.
Skeleton<WorldSpace> part_of(const Skeleton<WorldSpace>& person,
                             const std::vector<JointId>& joints) {
  Skeleton<WorldSpace> part;
  for (const JointId id : joints) part[id] = person[id];
  return part;
}

TEST(RayMatching, AFewJointsOfTwoCamerasStartNobody) {
  const std::vector four{JointId::SpineBase, JointId::Neck, JointId::Head, JointId::ShoulderLeft};
  std::vector five = four;
  five.push_back(JointId::ShoulderRight);
  RayRoom few;
  RayRoom enough;
  for (int i = 0; i < 5; ++i) few.see(kTwo, {part_of(standing_person(), four)});
  for (int i = 0; i < 5; ++i) enough.see(kTwo, {part_of(standing_person(), five)});
  EXPECT_TRUE(few.tracks.people.empty());
  EXPECT_EQ(enough.tracks.people.size(), 1u);
}

TEST(RayMatching, AFragmentThatGoesKeepsNobodyWaiting) {
  const std::vector joints{JointId::SpineBase, JointId::SpineShoulder, JointId::Neck,
                           JointId::Head,      JointId::ShoulderLeft,  JointId::ShoulderRight};
  RayRoom room;
  for (int i = 0; i < 90; ++i) room.see(kTwo, {part_of(standing_person(), joints)});
  for (int i = 0; i < 120; ++i) room.see(std::vector<SensorView>{});
  EXPECT_TRUE(room.tracks.missing.empty());
  std::vector<Person> people;
  for (int i = 0; i < 3; ++i) people = room.see(kFour, {standing_person({1.0, 0, 0})});
  EXPECT_EQ(people.size(), 1u) << "the actor is published at once";
}

TEST(RayMatching, AllCamerasThatSeeAPersonMeetInOne) {
  std::vector<PlacedView> views;
  for (const Camera& camera : kFour)
    views.push_back({.view = seen_by(camera, standing_person(), 1), .rays = true});
  const auto people = meet(views, 0.15, {});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].size(), 4u);
}

TEST(RayMatching, ALoneCameraFoundsNobodyAndKeepsThemForAWhile) {
  RayRoom room;
  const std::vector<Camera> lone{kTwo[0]};
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(room.see(lone, {standing_person()}).empty());
  EXPECT_TRUE(room.tracks.people.empty());
  for (int i = 0; i < 5; ++i) (void)room.see(kTwo, {standing_person()});
  std::vector<Person> people = room.see(lone, {standing_person()});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].views.size(), 1u);
  for (int i = 0; i < 60; ++i) people = room.see(lone, {standing_person({0.02 * i, 0, 0})});
  ASSERT_EQ(people.size(), 1u) << "for 2 s, and across its rays";
  EXPECT_EQ(people[0].views.size(), 1u);
  EXPECT_NEAR(core_of_track(room, 0).x(), 1.18, 0.1);
  for (int i = 0; i < 35; ++i) people = room.see(lone, {standing_person({1.2, 0, 0})});
  EXPECT_TRUE(people.empty()) << "nobody has placed it for over three seconds";
}

TEST(RayMatching, PeopleAreToldApartByHowTheirRaysMeet) {
  for (const auto& cameras : {kTwo, kFour}) {
    RayRoom room;
    const std::vector people{standing_person({0.8, 0, 0.1}), standing_person({-0.5, 0, 0.9}, 1.0),
                             standing_person({-0.3, 0, -0.9}, 2.0)};
    std::vector<Person> found;
    for (int i = 0; i < 3; ++i) found = room.see(cameras, people);
    ASSERT_EQ(found.size(), 3u) << cameras.size();
    for (const Track& track : room.tracks.people) {
      const bool real = std::ranges::any_of(people, [&](const Skeleton<WorldSpace>& person) {
        return (person[JointId::SpineShoulder].position - track.core).norm() < 0.3;
      });
      EXPECT_TRUE(real) << track.core.transpose();
    }
    for (const Person& person : found) EXPECT_EQ(person.views.size(), cameras.size());
  }
}

TEST(RayMatching, IdsStayWhenTwoPassEachOther) {
  RayRoom room;
  for (int i = 0; i < 90; ++i) {
    const double x = -1.5 + i / 30.0;
    const auto people = room.see(
        kFour, {standing_person({x, 0, 0.3}, 1.57), standing_person({-x, 0, -0.3}, -1.57)});
    if (i < 3) continue;
    ASSERT_EQ(people.size(), 2u) << i;
    ASSERT_EQ(room.tracks.people[0].id, PersonId{1});
    const double first = core_of_track(room, 0).z() > 0 ? x : -x;
    EXPECT_NEAR(core_of_track(room, 0).x(), first, 0.1) << i;
    EXPECT_EQ(core_of_track(room, 0).z() > 0, core_of_track(room, 1).z() < 0) << i;
  }
}

/// Camera 2 sees one person behind the other; only the size of the bodies shows which is which.
TEST(RayMatching, OneBehindAnotherIsToldApartBySize) {
  RayRoom room;
  const std::vector people{standing_person({1.2, 0, 0.3}), standing_person({-1.2, 0, 0.3})};
  std::vector<Person> found;
  for (int i = 0; i < 5; ++i) found = room.see(kFour, people);
  ASSERT_EQ(found.size(), 2u);
  for (const Person& person : found) {
    const auto body = locate([&] {
      std::vector<PlacedView> views;
      for (const SensorView& view : person.views)
        views.push_back({view, Eigen::Vector3d::Zero(), PlanError::Zero(), true});
      return views;
    }());
    const double x = middle_of(body)->x();
    EXPECT_NEAR(std::abs(x), 1.2, 0.05) << "mixed views would meet between them";
  }
}

TEST(RayMatching, ACameraJoinsSomebodyWhomADepthSensorSees) {
  RayRoom room;
  std::vector<Person> people;
  for (int i = 0; i < 4; ++i) {
    SensorView kinect = seen_by({9, {1, 1, -3}}, standing_person({0.4, 0, 0.2}), 1);
    kinect.skeleton = standing_person({0.4, 0, 0.2});
    people = room.see({kinect, seen_by(kTwo[0], standing_person({0.4, 0, 0.2}), 1)});
  }
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].views.size(), 2u);
}

TEST(RayMatching, RaysThatMeetBeyondTheRoomAreNobody) {
  RayRoom room;
  const std::vector<Camera> far{{1, {0, 1.4, -20}}, {2, {20, 1.6, 0.3}}};
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(room.see(far, {standing_person()}).empty());
  EXPECT_TRUE(room.tracks.people.empty());
}

TEST(RayMatching, LiarsWithManyBodiesCostLittle) {
  RayRoom room;
  std::vector<SensorView> views;
  for (int camera = 0; camera < 16; ++camera) {
    for (std::uint64_t body = 0; body < 16; ++body) {
      const auto b = static_cast<double>(body);
      const Eigen::Vector3d eye(4 * std::sin(0.4 * camera), 1.5, 4 * std::cos(0.4 * camera));
      views.push_back(
          seen_by({camera, eye}, standing_person({std::sin(b), 0, std::cos(2 * b)}), body));
    }
  }
  const std::clock_t before = std::clock();
  (void)room.see(views);
  EXPECT_LT(std::clock() - before, 4 * CLOCKS_PER_SEC) << "processor time, also under sanitizers";
}

}  // namespace
}  // namespace chorus::associate
