// Which sensors see people where no other sensor does.
#include "fusion-server/core/strays.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::core {
namespace {

using std::chrono::seconds;
using testing::kStart;
using testing::sensor_id;

/// A sensor "near" sees one person throughout; what "far" sees is told instant by instant.
struct TwoViews {
  TwoViews() {
    registration.sensors[near];
    registration.sensors[far];
  }

  Person person_at(const Eigen::Vector3d& place, const std::vector<SensorId>& sensors) const {
    Person person;
    for (const SensorId& sensor : sensors) {
      SensorView& view = person.views.emplace_back();
      view.sensor = sensor;
      view.skeleton = testing::standing_person(place);
    }
    return person;
  }

  void run(Duration length, const std::vector<Person>& people, std::size_t bodies_of_far,
           const std::vector<Standing>& standings = {}) {
    for (const Duration end = t + length; t < end; t += std::chrono::milliseconds(100)) {
      const std::vector<SensorReport> reports{{near, Basis::Exact, 1},
                                              {far, Basis::Exact, bodies_of_far}};
      strays.look({kStart + t, reports, people, standings, registration});
    }
  }

  /// A person in front of both sensors; `near_sees` and `far_shares` say which of them see the
  /// person.
  void run(Duration length, std::size_t bodies_of_far, bool far_shares, bool near_sees = true) {
    std::vector<SensorId> views;
    if (near_sees) views.push_back(near);
    if (far_shares) views.push_back(far);
    run(length, {person_at({0, -1.5, 3}, views)}, bodies_of_far);
  }

  [[nodiscard]] bool told() const { return strays.since(sensor_id("far")).has_value(); }

  const SensorId near = sensor_id("near");
  const SensorId far = sensor_id("far");
  Registration registration;
  Strays strays;
  Duration t{0};
};

TEST(Strays, AreToldAfterTenSecondsOfSeeingSomebodyElse) {
  TwoViews two;
  two.run(seconds(5), 1, true);
  two.run(seconds(9), 1, false);
  EXPECT_FALSE(two.told());
  two.run(seconds(2), 1, false);
  ASSERT_TRUE(two.told());
  EXPECT_EQ(*two.strays.since(sensor_id("far")), kStart + seconds(5));
  EXPECT_FALSE(two.strays.since(sensor_id("near")));
}

TEST(Strays, WhatNobodySeesIsNoEvidence) {
  TwoViews two;
  two.run(seconds(60), 0, false);  // far sees nobody
  EXPECT_FALSE(two.told());
  two.run(seconds(60), 1, false, false);  // near sees nobody
  EXPECT_FALSE(two.told());
}

TEST(Strays, SecondsInWhichItSeesNobodyAreNotCountedAndForgetNothing) {
  TwoViews two;
  two.run(seconds(6), 1, false);
  two.run(seconds(60), 0, false);
  EXPECT_FALSE(two.told());
  two.run(seconds(5), 1, false);
  EXPECT_TRUE(two.told());
}

TEST(Strays, OneSharedViewEndsIt) {
  TwoViews two;
  two.run(seconds(20), 1, false);
  ASSERT_TRUE(two.told());
  two.run(std::chrono::milliseconds(100), 1, true);
  EXPECT_FALSE(two.told());
}

TEST(Strays, AGhostThatIsPublishedIsToldOfWhereEitherMissesTheOthersPerson) {
  TwoViews two;
  Person ours = two.person_at({0, -1.5, 3}, {two.near});
  Person ghost = two.person_at({1, -1.5, 3}, {two.far});
  ours.id = PersonId{1};
  ghost.id = PersonId{2};
  const Standing of_ours{ours.id, {}, {two.near}, {two.far}};
  const Standing of_ghost{ghost.id, {}, {two.far}, {two.near}};
  two.run(seconds(60), {ours, ghost}, 1, {of_ours});
  two.run(seconds(60), {ours, ghost}, 1, {of_ghost});
  EXPECT_FALSE(two.told()) << "one of them may see farther than the other";
  two.run(seconds(11), {ours, ghost}, 1, {of_ours, of_ghost});
  EXPECT_TRUE(two.told());
}

TEST(Strays, TwoPeopleWhomTwoSensorsSeeEachInItsOwnPartOfTheRoomAreNoEvidence) {
  TwoViews two;
  const Person ours = two.person_at({0, -1.5, 3}, {two.near});
  two.run(seconds(60), {ours, two.person_at({9, -1.5, 3}, {two.far})}, 1);
  EXPECT_FALSE(two.told()) << "nobody looks where the other person is";
}

TEST(Strays, ALongPauseOfTheServerIsNotCounted) {
  TwoViews two;
  two.run(seconds(2), 1, false);
  two.t += seconds(3600);
  two.run(seconds(2), 1, false);
  EXPECT_FALSE(two.told());
  two.t -= seconds(7200);  // the clock was set back
  two.run(seconds(2), 1, false);
  EXPECT_FALSE(two.told());
}

TEST(Strays, OfSensorsThatAreNotConfiguredAreForgotten) {
  TwoViews two;
  two.run(seconds(20), 1, false);
  two.strays.keep({sensor_id("near")});
  EXPECT_FALSE(two.told());
  two.run(seconds(20), 1, false);
  two.strays.forget();
  EXPECT_FALSE(two.told());
}

}  // namespace
}  // namespace chorus::core
