// People come, leave and return: they are recognised by their build, and not taken for somebody
// else.
#include <algorithm>
#include <iterator>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "fusion-server/associate/person_association.h"
#include "tests/support/builders.h"
#include "tests/unit/associate/somebody.h"

namespace chorus::associate {
namespace {

using testing::kFrameInterval;
using testing::kStart;

/// Four sensors that all see everybody; a test that needs their poses sets `observers`.
struct RecognitionRoom {
  AssociationConfig config = {};
  std::vector<Observer> observers = {};
  Tracks tracks = {};
  Timestamp instant = kStart;

  int sensors = 4;
  std::uint64_t first_body = 1;  ///< The sensors' own id of the first of those who are seen.
  std::vector<Correction> corrections = {};
  std::map<PersonId, Timestamp> last_published = {};

  std::vector<Person> see(const std::vector<Somebody>& people) {
    instant += kFrameInterval;
    Scene scene{instant, {}, observers};
    for (int sensor = 0; sensor < sensors; ++sensor) {
      for (std::size_t i = 0; i < people.size(); ++i)
        scene.views.push_back(view_of_somebody(people[i], sensor, i + first_body));
    }
    Grouping grouping = group(std::move(scene), tracks, config);
    tracks = std::move(grouping.tracks);
    std::ranges::move(grouping.corrections, std::back_inserter(corrections));
    for (const Person& person : grouping.people) last_published[person.id] = instant;
    return std::move(grouping.people);
  }
  std::vector<Person> see_for(double time, const std::vector<Somebody>& people) {
    std::vector<Person> found;
    for (const Timestamp begun = instant; seconds(instant - begun) < time;) found = see(people);
    return found;
  }
  /// Time until somebody whom a sensor sees is published, about 10 s at most [s].
  double until_seen(const std::vector<Somebody>& people) {
    const Timestamp begun = instant;
    const auto seen = [](const Person& person) { return !person.carried; };
    while (std::ranges::none_of(see(people), seen) && seconds(instant - begun) < 10.0) {
    }
    return seconds(instant - begun);
  }
};

constexpr PersonId kFirst{1};

TEST(Recognition, WhoComesBackAfterTwentySecondsIsTheSamePerson) {
  RecognitionRoom room;
  EXPECT_EQ(room.see_for(3.0, {{0.0}}).at(0).id, kFirst);
  EXPECT_TRUE(room.see_for(20.0, {}).empty());
  EXPECT_TRUE(room.see_for(0.3, {{2.0}}).empty()) << "not before it is known who it is";
  const auto people = room.see_for(1.0, {{2.0}});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, kFirst);
}

TEST(Recognition, OneSensorAloneNeedsNoLongerThanIsConfigured) {
  RecognitionRoom room{.sensors = 1};
  EXPECT_EQ(room.see_for(3.0, {{0.0}}).at(0).id, kFirst);
  room.see_for(10.0, {});
  const double took = room.until_seen({{0.0}});
  EXPECT_LE(took, 1.0 + 0.15);
  EXPECT_GE(took, 1.0 - 0.05) << "nor less: four would";
}

TEST(Recognition, WhoIsProbablySomebodyKnownDoesNotWaitForCertainty) {
  RecognitionRoom room{.sensors = 2};
  EXPECT_EQ(room.see_for(15.0, {{0.0}}).at(0).id, kFirst);
  room.see_for(10.0, {});
  EXPECT_LE(room.until_seen({{0.0}}), 0.45);
  EXPECT_EQ(room.see({{0.0}}).at(0).id, kFirst);
}

TEST(Recognition, OfTwoWhoLeftTheRightOneComesBack) {
  RecognitionRoom room;
  const auto both = room.see_for(3.0, {{0.0, 1.0}, {2.0, 1.08}});
  ASSERT_EQ(both.size(), 2u);
  room.see_for(10.0, {});
  const auto people = room.see_for(1.5, {{0.0, 1.08}});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, both[1].id);
}

TEST(Recognition, WhoIsShownLargerAndSmallerInTurnsKeepsTheIdOverAGap) {
  RecognitionRoom room;
  for (int i = 0; i < 12; ++i) room.see_for(1.0, {{0.0, i % 2 == 0 ? 1.1 : 0.9}});
  room.see_for(0.5, {});
  const auto people = room.see_for(2.0, {{0.0, 1.1}});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, kFirst);
}

TEST(Recognition, SomebodyElseGetsAnIdOfTheirOwnAndInheritsNone) {
  RecognitionRoom room;
  room.see_for(3.0, {{0.0}});
  room.see_for(5.0, {});
  for (int i = 0; i < 60; ++i) {
    for (const Person& person : room.see({{0.0, 1.08}})) EXPECT_NE(person.id, kFirst) << i;
  }
  EXPECT_EQ(room.see({{0.0, 1.08}}).size(), 1u);
}

TEST(Recognition, NobodyWaitsWhileNobodyIsMissing) {
  RecognitionRoom room;
  EXPECT_LE(room.until_seen({{0.0}}), 0.15);
  const Timestamp begun = room.instant;
  while (room.see({{0.0}, {2.0, 1.08}}).size() < 2) {
  }
  EXPECT_LE(seconds(room.instant - begun), 0.15);
}

TEST(Recognition, AfterAMinuteNobodyIsRemembered) {
  RecognitionRoom room;
  room.see_for(3.0, {{0.0}});
  room.see_for(64.5, {});
  EXPECT_LE(room.until_seen({{0.0}}), 0.15);
  EXPECT_NE(room.see({{0.0}}).at(0).id, kFirst);
  RecognitionRoom forgetful{.config = {.remember = Duration{0}}};
  forgetful.see_for(3.0, {{0.0}});
  forgetful.see_for(5.0, {});
  EXPECT_LE(forgetful.until_seen({{0.0}}), 0.15);
}

TEST(Recognition, ContinuityIsQuestionedAfterAGap) {
  RecognitionRoom room;
  room.see_for(3.0, {{0.0}});
  room.see_for(0.5, {});
  room.see_for(1.5, {{0.0, 1.1}});  // somebody larger comes out
  const auto people = room.see({{0.0, 1.1}});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_NE(people[0].id, kFirst);
  room.see_for(5.0, {});
  EXPECT_EQ(room.see_for(2.0, {{0.0}}).at(0).id, kFirst) << "and who was lost is remembered";
}

TEST(Recognition, WhoIsLostAndFoundKeepsTheIdAllTheTime) {
  RecognitionRoom room;
  room.see_for(3.0, {{0.0}});
  room.see_for(0.5, {});
  for (int i = 0; i < 60; ++i) {
    const auto people = room.see({{0.0}});
    ASSERT_EQ(people.size(), 1u) << i;
    EXPECT_EQ(people[0].id, kFirst);
  }
}

TEST(Turn, WhoseViewsGoOverToSomebodyElseLosesTheId) {
  RecognitionRoom room;
  room.see_for(10.0, {{0.0}});
  const Timestamp changed = room.instant;
  const auto people = room.see_for(3.0, {{0.0, 1.1}});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_NE(people[0].id, kFirst);
  ASSERT_EQ(room.corrections.size(), 1u);
  EXPECT_EQ(room.corrections[0].published, kFirst);
  EXPECT_EQ(room.corrections[0].person, people[0].id);
  EXPECT_NEAR(seconds(room.corrections[0].since - changed), 0.0, 1.1) << "a tracklet at most";
  EXPECT_EQ(room.corrections[0].until, room.last_published.at(kFirst));
  room.see_for(5.0, {});
  EXPECT_EQ(room.see_for(2.0, {{0.0}}).at(0).id, kFirst) << "and who was lost is remembered";
}

/// Time until the person at 0 has another id than before [s]; the views go over to somebody larger.
double until_turned(bool other_bodies) {
  RecognitionRoom room;
  room.see_for(10.0, {{0.0}});
  if (other_bodies) room.first_body = 7;
  const Timestamp changed = room.instant;
  while (room.corrections.empty() && seconds(room.instant - changed) < 10.0)
    room.see({{0.0, 1.08}});
  return seconds(room.instant - changed);
}

TEST(Turn, IsNoticedAtOnceWhenAllBodiesAreNew) {
  EXPECT_LT(until_turned(true), 0.7);
  EXPECT_GT(until_turned(false), until_turned(true));
  EXPECT_LT(until_turned(false), 5.0);
}

TEST(Turn, OfTwoWhoseViewsWereExchangedBothGetTheirIdsBack) {
  RecognitionRoom room;
  const auto both = room.see_for(10.0, {{0.0, 1.0}, {2.0, 1.08}});
  ASSERT_EQ(both.size(), 2u);
  const auto people = room.see_for(3.0, {{0.0, 1.08}, {2.0, 1.0}});
  ASSERT_EQ(people.size(), 2u);
  const auto place = [&](PersonId id) {
    const auto found = std::ranges::find(people, id, &Person::id);
    return found == people.end() ? -1.0 : found->views.at(0).skeleton[JointId::Neck].position.x();
  };
  EXPECT_NEAR(place(both[0].id), 2.0, 0.1);
  EXPECT_NEAR(place(both[1].id), 0.0, 0.1);
  EXPECT_EQ(room.corrections.size(), 2u);
  EXPECT_TRUE(room.tracks.missing.empty()) << "nobody left";
}

TEST(Turn, NobodyIsSplitWhoseBodiesAreNewInEachFrame) {
  RecognitionRoom room;
  for (int i = 0; i < 300; ++i) {
    room.first_body += 2;
    room.see({{0.0, i % 3 == 0 ? 1.01 : 0.995}});
  }
  EXPECT_TRUE(room.corrections.empty());
  EXPECT_EQ(room.see({{0.0}}).at(0).id, kFirst);
}

TEST(Missing, WhoWasSeenTooBrieflyKeepsNobodyWaiting) {
  RecognitionRoom room;
  EXPECT_EQ(room.see_for(0.5, {{0.0}}).size(), 1u);
  room.see_for(5.0, {});
  EXPECT_TRUE(room.tracks.missing.empty());
  EXPECT_LE(room.until_seen({{2.0}}), 0.15);
}

TEST(Carried, SomebodyWhomNobodySeesIsAnsweredForASecond) {
  RecognitionRoom room;
  room.see_for(2.0, {{0.0}});
  const auto people = room.see_for(0.5, {});
  ASSERT_EQ(people.size(), 1u);
  ASSERT_TRUE(people[0].carried.has_value());
  EXPECT_TRUE(people[0].views.empty());
  EXPECT_NEAR(people[0].carried->x(), 0.0, 0.05);
  EXPECT_TRUE(room.see_for(0.6, {}).empty());
}

std::vector<Observer> on_a_ring(const std::vector<int>& places) {
  std::vector<Observer> observers;
  for (const int place : places)
    observers.push_back(
        {testing::sensor_id("s" + std::to_string(place)), testing::ring_sensor(place, 4)});
  return observers;
}

TEST(Carried, WhomSensorsOnDifferentSidesSeeThroughHasLeft) {
  RecognitionRoom room{.observers = on_a_ring({0, 1, 2, 3})};
  room.see_for(2.0, {{0.0}});
  EXPECT_TRUE(room.see_for(0.4, {}).empty());
  EXPECT_TRUE(room.tracks.people.empty());
  ASSERT_EQ(room.tracks.missing.size(), 1u);
  RecognitionRoom one_side{.observers = on_a_ring({0})};
  one_side.see_for(2.0, {{0.0}});
  EXPECT_EQ(one_side.see_for(0.4, {}).size(), 1u) << "something may stand in the way";
}

TEST(Rivals, ASecondBodyOfOneSensorBesideAPersonFoundsNobody) {
  RecognitionRoom room;
  room.see_for(2.0, {{0.0}});
  room.instant += kFrameInterval;
  Scene scene{room.instant, {}};
  for (int sensor = 0; sensor < 4; ++sensor)
    scene.views.push_back(view_of_somebody({0.0}, sensor, 1));
  scene.views.push_back(view_of_somebody({0.2}, 2, 2));
  EXPECT_EQ(group(scene, room.tracks, room.config).tracks.people.size(), 1u);
  scene.views.push_back(view_of_somebody({0.2}, 3, 2));
  EXPECT_EQ(group(scene, room.tracks, room.config).tracks.people.size(), 2u) << "two see two";
}

}  // namespace
}  // namespace chorus::associate
