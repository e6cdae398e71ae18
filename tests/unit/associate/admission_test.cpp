// Which tracks are published at once, and which wait because other sensors should see them but do
// not.
#include "fusion-server/associate/admission.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::associate {
namespace {

constexpr int kSensors = 4;
constexpr Duration kAdmissionFrame = std::chrono::milliseconds(33);

Observer observer(int sensor) {
  return {testing::sensor_id("s" + std::to_string(sensor)), testing::ring_sensor(sensor, kSensors)};
}

std::vector<Observer> all() {
  std::vector<Observer> observers;
  for (int i = 0; i < kSensors; ++i) observers.push_back(observer(i));
  return observers;
}

struct Body {
  int sensor;
  double x;
  double z;
  std::uint64_t id = 1;
};

SensorView view_of(const Body& body) {
  SensorView view;
  view.sensor = observer(body.sensor).sensor;
  view.body = BodyId{body.id};
  for (const JointId id : {JointId::SpineBase, JointId::Neck, JointId::Head}) {
    view.skeleton[id].position = {body.x, 0.9 + 0.2 * static_cast<double>(id), body.z};
    view.skeleton[id].state = JointState::Tracked;
  }
  return view;
}

/// A ring of four sensors at 2.5 m; a person whom a sensor does not see counts as missed by it.
struct AdmissionRoom {
  AssociationConfig config = {};
  std::vector<Observer> observers = all();
  Tracks tracks = {};
  Timestamp instant = testing::kStart;

  std::vector<Person> see(const std::vector<Body>& bodies) {
    instant += kAdmissionFrame;
    Scene scene{instant, {}, observers};
    for (const Body& body : bodies) scene.views.push_back(view_of(body));
    Grouping grouping = group(std::move(scene), tracks, config);
    tracks = std::move(grouping.tracks);
    return std::move(grouping.people);
  }
  /// Time until more than `people` people are published, at most `limit` [s].
  double until_more_than(std::size_t people, const std::vector<Body>& bodies, double limit) {
    const Timestamp begun = instant;
    while (see(bodies).size() <= people && seconds(instant - begun) < limit) {
    }
    return seconds(instant - begun);
  }
};

constexpr double kAtOnce = 0.1 + 1e-9;  // three instants [s]

std::vector<Body> seen_by_all(double x, double z) {
  std::vector<Body> bodies;
  for (int i = 0; i < kSensors; ++i) bodies.push_back({i, x, z});
  return bodies;
}

TEST(Admission, WhomTwoSensorsSeeIsPublishedAtOnce) {
  AdmissionRoom room;
  EXPECT_LE(room.until_more_than(0, {{0, 0, 0}, {1, 0.1, 0}}, 1.0), kAtOnce);
}

TEST(Admission, AGhostThatOthersSeeThroughWaits) {
  AdmissionRoom room{.observers = {observer(0), observer(1)}};
  const double waited = room.until_more_than(0, {{0, 0.2, 0.1}}, 10.0);
  EXPECT_NEAR(waited, seconds(room.config.alone), 0.2);
}

TEST(Admission, AGhostThatIsSeenThroughFromDifferentSidesWaitsOn) {
  AdmissionRoom room;
  EXPECT_GE(room.until_more_than(0, {{0, 0.2, 0.1}}, 20.0), 20.0);
}

TEST(Admission, ItIsPublishedAsSoonAsAnotherConfirmsIt) {
  AdmissionRoom room;
  EXPECT_GE(room.until_more_than(0, {{0, 0, 0}}, 1.0), 1.0);
  const auto people = room.see({{0, 0, 0}, {2, 0.1, 0}});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, PersonId{1});
  EXPECT_EQ(room.see({{0, 0, 0}}).size(), 1u) << "and stays, when it is alone again";
}

TEST(Admission, TheOnlySensorWaitsForNobody) {
  AdmissionRoom room{.observers = {observer(0)}};
  EXPECT_LE(room.until_more_than(0, {{0, 0, 0}}, 1.0), kAtOnce);
}

TEST(Admission, WhereNobodyElseLooksOneSensorIsEnough) {
  AdmissionRoom behind_the_others{.observers = {observer(0), observer(2)}};
  EXPECT_LE(behind_the_others.until_more_than(0, {{0, 0, 3.0}}, 1.0), kAtOnce);
  AdmissionRoom out_of_reach{.config = {.look_range = 1.5},
                             .observers = {observer(0), observer(2)}};
  EXPECT_LE(out_of_reach.until_more_than(0, {{0, 0, -1.0}}, 1.0), kAtOnce);
  AdmissionRoom beside_the_cone{.config = {.look_angle = deg(5)},
                                .observers = {observer(0), observer(2)}};
  EXPECT_LE(beside_the_cone.until_more_than(0, {{0, 0.7, 0}}, 1.0), kAtOnce);
}

TEST(Admission, WhoStandsBehindSomebodyIsNotMissed) {
  AdmissionRoom room{.observers = {observer(0), observer(2)}};
  // Sensor 2 looks along -z: for it the person at z = 0.8 occludes the one at -0.5.
  const std::vector<Body> front{{0, 0, 0.8, 1}, {2, 0, 0.8, 1}};
  for (int i = 0; i < 10; ++i) room.see(front);
  std::vector<Body> both = front;
  both.push_back({0, 0.05, -0.5, 2});
  EXPECT_LE(room.until_more_than(1, both, 1.0), kAtOnce);
}

TEST(Admission, ASensorThatDoesNotAnswerMissesNobody) {
  AdmissionRoom room{.observers = {observer(0)}};
  EXPECT_EQ(room.until_more_than(0, {{0, 0, 0}}, 1.0) <= kAtOnce, true);
  room.observers = all();
  EXPECT_EQ(room.see({{0, 0, 0}}).size(), 1u) << "whoever is published stays";
}

TEST(Admission, AMissingAnswerDoesNotEndTheWait) {
  AdmissionRoom room;
  for (int i = 0; i < 6; ++i) room.see({{0, 0, 0}});
  room.observers = {observer(0)};
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(room.see({{0, 0, 0}}).empty());
}

TEST(Admission, AMisplacedSensorMakesNoSecondPerson) {
  AdmissionRoom room;
  for (int i = 0; i < 10; ++i) room.see(seen_by_all(0, 0));
  std::vector<Body> astray = seen_by_all(0, 0);
  astray[3].x += 1.0;
  EXPECT_GE(room.until_more_than(1, astray, 20.0), 20.0);
}

/// Sensors 0 and 2 see somebody in the middle. Sensor 1 looks there, too, and shows a body behind
/// sensor 2 instead, where only sensor 0 looks and sees nobody.
TEST(Admission, WhoDoesNotSeeThePersonOthersSeeIsNotBelievedElsewhere) {
  AdmissionRoom astray{.config = {.look_range = 8.0}};
  astray.observers.pop_back();
  AdmissionRoom sound = astray;
  const std::vector<Body> middle{{0, 0, 0, 1}, {2, 0, 0, 1}};
  std::vector<Body> bodies = middle;
  bodies.push_back({1, 1.5, 3.0, 2});
  EXPECT_GE(astray.until_more_than(1, bodies, 20.0), 20.0);
  bodies.push_back({1, 0, 0, 1});
  EXPECT_NEAR(sound.until_more_than(1, bodies, 20.0), seconds(sound.config.alone), 0.2)
      << "a sensor that sees the person, too, may see a second one";
}

TEST(Admission, WhoSeesManyAloneIsBelievedLater) {
  AdmissionRoom room{.observers = {observer(0), observer(1)}};
  std::vector<Body> crowd{{0, 0, 0}, {1, 0, 0}};
  for (std::uint64_t i = 0; i < 5; ++i)
    crowd.push_back({0, -0.4 + 0.2 * static_cast<double>(i), 0.9, i + 2});
  EXPECT_NEAR(room.until_more_than(1, crowd, 60.0), 5 * seconds(room.config.alone), 0.5);
}

TEST(Admission, ASecondBodyOfOneSensorBesideAPersonWaits) {
  AdmissionRoom room;
  std::vector<Body> bodies = seen_by_all(0, 0);
  bodies.push_back({0, 0.2, 0, 2});
  EXPECT_GE(room.until_more_than(1, bodies, 2.0), 2.0);
}

TEST(Admission, AWaitingGhostDoesNotTakeAPersonsId) {
  AdmissionRoom room;
  room.see({{0, 0, 0}});  // a ghost gets the first id
  for (int i = 0; i < 30; ++i) room.see({{0, 0, 0}});
  std::uint64_t id = 0;
  for (int i = 0; i < 60; ++i) {  // a person walks up to it, and past
    const double z = 1.0 - 0.03 * i;
    const auto people = room.see({{0, 0, 0}, {1, 0.1, z}, {2, 0.1, z}, {3, 0.1, z}});
    if (i < 5) continue;
    ASSERT_EQ(people.size(), 1u) << i;
    if (id == 0) id = people[0].id.value;
    EXPECT_EQ(people[0].id.value, id) << i;
  }
}

TEST(Admission, WithoutAWaitEverybodyIsPublished) {
  AdmissionRoom room{.config = {.alone = Duration{0}}};
  EXPECT_LE(room.until_more_than(0, {{0, 0, 0}}, 1.0), kAtOnce);
}

/// A place at which sensor 0 alone looks; the room has been observed for longer than `motionless`.
struct QuietRoom : AdmissionRoom {
  QuietRoom() {
    observers = {observer(0), observer(2)};
    for (int i = 0; i < 330; ++i) see({});
  }
};
constexpr Body kAtRest{0, 0, 3.0};

TEST(Admission, WhoAppearsAtRestBeforeOneSensorAloneWaits) {
  QuietRoom room;
  EXPECT_NEAR(room.until_more_than(0, {kAtRest}, 20.0), seconds(room.config.motionless), 0.2);
}

TEST(Admission, WhoMovesThereWaitsNoLonger) {
  QuietRoom room;
  for (int i = 0; i < 30; ++i) EXPECT_TRUE(room.see({kAtRest}).empty());
  EXPECT_TRUE(room.see({{0, 0.2, 3.0}}).empty()) << "a trembling chair";
  EXPECT_EQ(room.see({{0, 0.3, 3.0}}).size(), 1u);
  EXPECT_EQ(room.see({kAtRest}).size(), 1u) << "and stays";
}

TEST(Admission, WhoIsThereFromTheStartDoesNotWait) {
  AdmissionRoom room{.observers = {observer(0), observer(2)}};
  for (int i = 0; i < 30; ++i) room.see({});
  EXPECT_LE(room.until_more_than(0, {kAtRest}, 1.0), kAtOnce);
}

TEST(Admission, NobodyWaitsAtRestWhileSomebodyIsMissing) {
  QuietRoom room;
  room.tracks.missing.push_back({PersonId{99}, room.instant, {}});
  EXPECT_LT(room.until_more_than(0, {kAtRest}, 8.0), 5.0) << "only until it is recognised";
}

TEST(Admission, NobodyWaitsAtRestInARoomOfOneSensor) {
  QuietRoom room;
  room.observers = {observer(0)};
  EXPECT_LE(room.until_more_than(0, {kAtRest}, 1.0), kAtOnce);
}

}  // namespace
}  // namespace chorus::associate
