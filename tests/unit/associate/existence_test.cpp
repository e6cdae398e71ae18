// Which tracks are published, and which are not because other sensors should see them but do not.
#include "fusion-server/associate/existence.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "fusion-server/associate/person_association.h"
#include "tests/support/builders.h"

namespace chorus::associate {
namespace {

constexpr int kSensors = 4;
constexpr Duration kContestedFrame = std::chrono::milliseconds(33);

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
  double y = 0.0;  ///< Of the floor on which it stands.
};

SensorView view_of(const Body& body) {
  SensorView view;
  view.sensor = observer(body.sensor).sensor;
  view.body = BodyId{body.id};
  for (const JointId id : {JointId::SpineBase, JointId::Neck, JointId::Head}) {
    view.skeleton[id].position = {body.x, body.y + 0.9 + 0.2 * static_cast<double>(id), body.z};
    view.skeleton[id].state = JointState::Tracked;
  }
  return view;
}

/// A ring of four sensors at 2.5 m; a person whom a sensor does not see counts as missed by it.
struct ContestedRoom {
  AssociationConfig config = {};
  std::vector<Observer> observers = all();
  Tracks tracks = {};
  Timestamp instant = testing::kStart;
  std::vector<Standing> standings = {};

  std::vector<Person> see(const std::vector<Body>& bodies) {
    instant += kContestedFrame;
    Scene scene{instant, {}, observers};
    for (const Body& body : bodies) scene.views.push_back(view_of(body));
    Grouping grouping = group(std::move(scene), tracks, config);
    tracks = std::move(grouping.tracks);
    standings = std::move(grouping.standings);
    return std::move(grouping.people);
  }
  std::size_t see_for(double time, const std::vector<Body>& bodies) {
    std::size_t people = 0;
    for (const Timestamp begun = instant; seconds(instant - begun) < time;)
      people = see(bodies).size();
    return people;
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

TEST(Existence, WhomTwoSensorsSeeIsPublishedAtOnceOrSoonWhereTwoMissThem) {
  ContestedRoom alone{.observers = {observer(0), observer(1)}};
  EXPECT_LE(alone.until_more_than(0, {{0, 0, 0}, {1, 0.1, 0}}, 1.0), kAtOnce);
  ContestedRoom room;
  const double waited = room.until_more_than(0, {{0, 0, 0}, {1, 0.1, 0}}, 1.0);
  EXPECT_GT(waited, kAtOnce);
  EXPECT_LE(waited, 0.27);
}

TEST(Existence, OneAgainstOneWaitsFromTheFirstInstantOnIfItDoesNotMove) {
  ContestedRoom room{.observers = {observer(0), observer(1)}};
  const double waited = room.until_more_than(0, {{0, 0.2, 0.1}}, 20.0);
  EXPECT_NEAR(waited, seconds(room.config.doubt), 0.7);
  ContestedRoom at_once{.config = {.doubt = Duration{0}}, .observers = {observer(0), observer(1)}};
  EXPECT_LE(at_once.until_more_than(0, {{0, 0.2, 0.1}}, 20.0), kAtOnce);
}

TEST(Existence, WhoWalksThereIsPublishedSoonButNotWhoLeaps) {
  ContestedRoom room{.observers = {observer(0), observer(1)}};
  EXPECT_EQ(room.see_for(1.0, {{0, 0.0, 0.1}}), 0u);
  EXPECT_EQ(room.see_for(1.0, {{0, 0.2, 0.1}}), 0u) << "a trembling chair";
  EXPECT_EQ(room.see_for(1.0, {{0, 0.6, 0.1}}), 0u) << "the next chair";
  std::size_t people = 0;
  for (int i = 0; i < 20; ++i) people = room.see({{0, 0.6 - 0.04 * i, 0.1}}).size();
  EXPECT_EQ(people, 1u);
  EXPECT_EQ(room.see_for(1.0, {{0, -0.2, 0.1}}), 1u) << "and stays";
}

TEST(Existence, OneAgainstThreeIsNeverPublished) {
  ContestedRoom room;
  EXPECT_GE(room.until_more_than(0, {{0, 0.2, 0.1}}, 20.0), 20.0);
  ASSERT_EQ(room.standings.size(), 1u);
  EXPECT_FALSE(room.standings[0].admitted);
  EXPECT_EQ(room.standings[0].seen_by, std::vector{testing::sensor_id("s0")});
  EXPECT_EQ(room.standings[0].missed_by.size(), 3u);
}

TEST(Existence, ItIsPublishedAsSoonAsOthersConfirmIt) {
  ContestedRoom room;
  room.see_for(5.0, {{0, 0, 0}});
  EXPECT_LT(room.until_more_than(0, {{0, 0, 0}, {1, 0.1, 0}, {2, 0.1, 0}}, 5.0), 0.7);
  room.see_for(1.0, {{0, 0, 0}, {1, 0.1, 0}, {2, 0.1, 0}});
  EXPECT_EQ(room.see({{0, 0, 0}}).size(), 1u) << "not gone in an instant";
  EXPECT_EQ(room.see_for(3.0, {{0, 0, 0}}), 0u) << "but contested for as long as it lives";
}

constexpr int kSix = 6;
std::vector<Observer> ring_of_six() {
  std::vector<Observer> observers;
  for (int i = 0; i < kSix; ++i)
    observers.push_back(
        {testing::sensor_id("s" + std::to_string(i)), testing::ring_sensor(i, kSix)});
  return observers;
}

std::vector<Body> seen_by_six() {
  std::vector<Body> bodies;
  for (int i = 0; i < kSix; ++i) bodies.push_back({i, 0, 0});
  return bodies;
}

/// A mirror: two sensors see somebody a second time, 1 m beside; it moves as the person does.
TEST(Existence, OnWhomTwoOfSixAgreeIsContested) {
  ContestedRoom room{.observers = ring_of_six()};
  for (int i = 0; i < 300; ++i) {
    std::vector<Body> bodies = seen_by_six();
    const double x = 0.3 * std::sin(0.03 * i);
    for (Body& body : bodies) body.x = x;
    for (const int sensor : {1, 2}) bodies.push_back({sensor, x + 0.9, 0.5, 2});
    ASSERT_LE(room.see(bodies).size(), 1u) << i;
  }
  EXPECT_EQ(room.standings.size(), 2u);
  EXPECT_FALSE(room.standings[1].admitted);
}

TEST(Existence, OnWhomTwoAgreedBeforeOthersAnsweredIsGoneWithinASecond) {
  ContestedRoom room{.observers = {ring_of_six()[1], ring_of_six()[2]}};
  const std::vector<Body> ghost{{1, 0.4, 0.2}, {2, 0.4, 0.2}};
  EXPECT_EQ(room.see_for(0.3, ghost), 1u);
  room.observers = ring_of_six();
  EXPECT_EQ(room.see_for(1.0, ghost), 0u);
}

/// Of four sensors, two see the person 1 m beside, and not where the person is.
TEST(Existence, LiarsWhoMissThePersonOthersSeeAreNotBelieved) {
  ContestedRoom room{.observers = {ring_of_six()[0], ring_of_six()[1], ring_of_six()[2],
                                   ring_of_six()[3], ring_of_six()[4]}};
  const std::vector<Body> bodies{{0, 0, 0}, {3, 0, 0}, {4, 0, 0}, {1, 1, 0}, {2, 1, 0}};
  EXPECT_EQ(room.see_for(5.0, bodies), 1u);
}

/// Two see somebody where only they look, and not the person 0.8 m before them whom four see.
TEST(Existence, WhoIsSeenInsteadOfThePersonBesideIsNotBelieved) {
  ContestedRoom astray{.observers = ring_of_six()};
  ContestedRoom sound = astray;
  std::vector<Body> bodies{{1, 2.3, 0, 2}, {2, 2.3, 0, 2}};
  for (const int sensor : {0, 3, 4, 5}) bodies.push_back({sensor, 1.5, 0});
  for (int i = 0; i < 100; ++i) ASSERT_LE(astray.see(bodies).size(), i < 30 ? 2u : 1u) << i;
  for (const int sensor : {1, 2}) bodies.push_back({sensor, 1.5, 0});
  EXPECT_EQ(sound.see_for(1.0, bodies), 2u) << "whoever sees the person may see a second one";
}

TEST(Existence, TwoAgainstTwoAreBothPublished) {
  ContestedRoom room;
  EXPECT_EQ(room.see_for(3.0, {{0, -0.5, 0}, {2, -0.5, 0}, {1, 0.5, 0}, {3, 0.5, 0}}), 2u);
}

TEST(Existence, ABodyUnderTheFloorOrHighAboveItIsContested) {
  for (const double y : {-2.2, 10.0}) {
    ContestedRoom room;
    room.see_for(1.0, seen_by_all(0, 0));
    std::vector<Body> bodies = seen_by_all(0, 0);
    bodies.push_back({0, 0.5, 0.5, 2, y});
    bodies.push_back({1, 0.5, 0.5, 2, y});
    EXPECT_EQ(room.see_for(2.0, bodies), 1u) << y;
    ASSERT_EQ(room.standings.size(), 2u) << y;
    EXPECT_FALSE(room.standings[1].on_floor) << y;
  }
}

TEST(Existence, ABodyUnderTheFloorIsNobodyEvenIfAllSeeIt) {
  ContestedRoom room{.observers = {observer(0), observer(1)}};
  room.observers[0].knows_floor = true;
  EXPECT_EQ(room.see_for(3.0, {{0, 0, 0, 1, -2.2}, {1, 0, 0, 1, -2.2}}), 0u);
}

TEST(Existence, WhereNobodyKnowsTheFloorHeightsSayNothing) {
  ContestedRoom room{.observers = {observer(0)}};
  EXPECT_EQ(room.see_for(1.0, {{0, 0, 0, 1, -2.2}}), 1u);
  room.observers[0].knows_floor = true;
  EXPECT_EQ(room.see_for(2.0, {{0, 0, 0, 1, -2.2}}), 0u);
  EXPECT_EQ(room.see_for(2.0, {{0, 0, 0, 1, -0.3}}), 1u) << "a floor is not known to a millimetre";
}

TEST(Existence, TheOnlySensorIsBelieved) {
  ContestedRoom room{.observers = {observer(0)}};
  EXPECT_LE(room.until_more_than(0, {{0, 0, 0}}, 1.0), kAtOnce);
}

/// A place behind sensor 2.
TEST(Existence, WhereNobodyElseLooksOneSensorIsEnoughIfTheBodyMovesOrAfterAWhile) {
  ContestedRoom still{.observers = {observer(0), observer(2)}};
  EXPECT_NEAR(still.until_more_than(0, {{0, 0, 3.0}}, 9.0), seconds(still.config.doubt) / 5, 0.2);
  ContestedRoom moving{.observers = {observer(0), observer(2)}};
  std::size_t people = 0;
  for (int i = 0; i < 9; ++i) people = moving.see({{0, 0, 2.9 + 0.04 * i}}).size();
  EXPECT_EQ(people, 1u);
}

/// 28 degrees off the axis of sensor 1, 3.6 m away: no certain sight by the rule of a narrow cone.
TEST(Existence, ASensorLooksAsFarAsItsFieldOfViewGoes) {
  ContestedRoom room{.observers = {observer(0), observer(1)}};
  EXPECT_GT(room.until_more_than(0, {{0, 0.7, -1.7}}, 5.0), 4.9);
}

TEST(Existence, WhoStandsBehindSomebodyIsNotMissed) {
  ContestedRoom room{.observers = {observer(0), observer(2)}};
  // Sensor 2 looks along -z: for it the person at z = 0.8 occludes the one at -0.5.
  const std::vector<Body> front{{0, 0, 0.8, 1}, {2, 0, 0.8, 1}};
  for (int i = 0; i < 10; ++i) room.see(front);
  std::vector<Body> both = front;
  both.push_back({0, 0.05, -0.5, 2});
  EXPECT_LE(room.until_more_than(1, both, 9.0), 2.2) << "no longer than where nobody looks";
}

TEST(Existence, AMissingAnswerDoesNotEndTheWait) {
  ContestedRoom room;
  for (int i = 0; i < 6; ++i) room.see({{0, 0, 0}});
  room.observers = {observer(0)};
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(room.see({{0, 0, 0}}).empty());
}

TEST(Existence, AMisplacedSensorMakesNoSecondPerson) {
  ContestedRoom room;
  for (int i = 0; i < 10; ++i) room.see(seen_by_all(0, 0));
  std::vector<Body> astray = seen_by_all(0, 0);
  astray[3].x += 1.0;
  EXPECT_GE(room.until_more_than(1, astray, 20.0), 20.0);
}

/// Sensors 0 and 2 see somebody in the middle.  Sensor 1 looks there, too, and shows a moving body
/// elsewhere instead, where only sensor 0 looks and sees nobody.
TEST(Existence, WhoDoesNotSeeThePersonOthersSeeIsNotBelievedElsewhere) {
  ContestedRoom astray{.observers = {observer(0), observer(1), observer(2)}};
  ContestedRoom sound = astray;
  for (int i = 0; i < 300; ++i) {
    std::vector<Body> bodies{{0, 0, 0, 1}, {2, 0, 0, 1}};
    bodies.push_back({1, -0.9, 1.2 + 0.004 * std::min(i, 100), 2});
    ASSERT_EQ(astray.see(bodies).size() > 1, false) << i;
    bodies.push_back({1, 0, 0, 1});
    const std::size_t found = sound.see(bodies).size();
    if (i < 299) continue;
    EXPECT_EQ(found, 2u) << "a sensor that sees the person may see a second one";
  }
}

TEST(Existence, WhoSeesManyAloneIsBelievedLess) {
  std::vector<Body> crowd{{0, 0, 0}, {1, 0, 0}};
  for (std::uint64_t i = 0; i < 5; ++i)
    crowd.push_back({0, -0.6 + 0.3 * static_cast<double>(i), 0.9, i + 2});
  ContestedRoom room{.observers = {observer(0), observer(1)}};
  EXPECT_GE(room.until_more_than(1, crowd, 60.0), 60.0);
}

TEST(Existence, ASecondBodyOfOneSensorBesideAPersonWaits) {
  ContestedRoom room;
  std::vector<Body> bodies = seen_by_all(0, 0);
  bodies.push_back({0, 0.2, 0, 2});
  EXPECT_GE(room.until_more_than(1, bodies, 2.0), 2.0);
}

TEST(Existence, AWaitingGhostDoesNotTakeAPersonsId) {
  ContestedRoom room;
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

}  // namespace
}  // namespace chorus::associate
