#include "fusion-server/associate/person_association.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace chorus::associate {
namespace {

constexpr Duration kFrame = std::chrono::milliseconds(33);
constexpr Timestamp kAssociationStart = from_unix_ns(1'790'000'000'000'000'000);

SensorView view(int sensor, double x, double z, std::uint64_t body = 1) {
  SensorView sight;
  sight.sensor = SensorId::parse("s" + std::to_string(sensor)).value();
  sight.body = BodyId{body};
  for (const JointId id : {JointId::SpineBase, JointId::Neck, JointId::Head}) {
    sight.skeleton[id].position = {x, 1.0 + 0.2 * static_cast<double>(id), z};
    sight.skeleton[id].state = JointState::Tracked;
  }
  return sight;
}

/// Processes instants one frame apart and keeps the tracks.
struct Room {
  Tracks tracks;
  Timestamp instant = kAssociationStart;
  AssociationConfig config;

  std::vector<Person> see(std::vector<SensorView> views) {
    instant += kFrame;
    Grouping grouping = group({instant, std::move(views)}, tracks, config);
    tracks = grouping.tracks;
    return grouping.people;
  }
  std::vector<Person> see_often(const std::vector<SensorView>& views, int times) {
    std::vector<Person> people;
    for (int i = 0; i < times; ++i) people = see(views);
    return people;
  }
};

TEST(Group, ViewsOfManySensorsBecomeOnePersonOnceConfirmed) {
  Room room;
  const std::vector views{view(1, 0, 0), view(2, 0.1, 0), view(3, 0, 0.1)};
  EXPECT_TRUE(room.see_often(views, 2).empty());
  const auto people = room.see(views);
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, PersonId{1});
  EXPECT_EQ(people[0].views.size(), 3u);
}

TEST(Group, TwoBodiesOfOneSensorAreNeverOnePerson) {
  Room room;
  const auto people = room.see_often({view(1, 0, 0, 1), view(1, 0.1, 0, 2)}, 3);
  EXPECT_EQ(people.size(), 2u);
}

TEST(Group, TheIdStaysWhileThePersonWalksAndBodiesSwapIds) {
  Room room;
  for (int i = 0; i < 100; ++i) {
    const double x = 0.04 * i;  // 1.2 m/s
    const auto body = static_cast<std::uint64_t>(i % 7);
    const auto people = room.see({view(1, x, 0, body), view(2, x, 0.05, body + 1)});
    if (i < 3) continue;
    ASSERT_EQ(people.size(), 1u);
    EXPECT_EQ(people[0].id, PersonId{1});
  }
}

TEST(Group, TwoPeopleKeepTheirIdsWhenTheyPass) {
  Room room;
  for (int i = 0; i < 100; ++i) {
    const double x = -2.0 + 0.04 * i;
    const auto people = room.see({view(1, x, 0, 1), view(1, -x, 0.5, 2)});
    if (i < 3) continue;
    ASSERT_EQ(people.size(), 2u);
    const auto core_x = [&](std::size_t k) {
      return people[k].views.at(0).skeleton[JointId::Neck].position.x();
    };
    EXPECT_EQ(people[0].id, PersonId{1});
    EXPECT_NEAR(core_x(0), x, 1e-9);
    EXPECT_NEAR(core_x(1), -x, 1e-9);
  }
}

TEST(Group, ATrackOutlivesAShortGapAndIdsAreNeverReused) {
  Room room;
  room.config.remember = Duration{0};
  room.see_often({view(1, 0, 0)}, 3);
  room.see_often({}, 60);  // 2 s
  auto people = room.see({view(1, 0, 0)});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, PersonId{1});
  room.see_often({}, 100);  // 3.3 s
  EXPECT_TRUE(room.tracks.people.empty());
  people = room.see_often({view(1, 0, 0)}, 3);
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, PersonId{2});
}

TEST(Group, AViewThatIsTooFarOffDoesNotPushAnotherOneAside) {
  Room room;
  room.see_often({view(1, 0, 0, 1), view(1, 0.55, 0, 2), view(2, 0, 0), view(2, 0.55, 0, 2)}, 5);
  // One of the two people leaves and the other steps aside; to match both views would cost more
  // than to match one and take the other for a newcomer.
  const auto people = room.see({view(1, 0.56, 0, 2), view(1, 1.12, 0, 3), view(2, 0.56, 0, 2)});
  const auto second = std::ranges::find(people, PersonId{2}, &Person::id);
  ASSERT_NE(second, people.end());
  EXPECT_EQ(second->views.size(), 2u);
  EXPECT_NEAR(second->views[0].skeleton[JointId::Neck].position.x(), 0.56, 1e-9);
}

TEST(Group, OnePersonSeenByDifferentSensorsInTwoTracksBecomesOne) {
  Room room;
  room.see_often({view(1, 0, 0), view(2, 0.9, 0)}, 5);  // two tracks: 0.9 m apart
  EXPECT_EQ(room.tracks.people.size(), 2u);
  const auto people = room.see_often({view(1, 0.3, 0), view(2, 0.6, 0)}, 40);
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, PersonId{1});
  EXPECT_EQ(people[0].views.size(), 2u);
}

TEST(Group, TimeGoingBackwardsStartsAnewWithoutACrash) {
  Room room;
  room.see_often({view(1, 0, 0)}, 3);
  room.instant -= std::chrono::hours(1);
  const auto people = room.see_often({view(1, 0, 0)}, 3);
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, PersonId{2});
}

TEST(Group, ABodyWithoutAnySeenJointIsLeftOut) {
  Room room;
  SensorView nothing;
  nothing.sensor = SensorId::parse("s1").value();
  EXPECT_TRUE(room.see_often({nothing}, 5).empty());
  EXPECT_TRUE(room.tracks.people.empty());
}

TEST(Group, AnOccludedLowerBodyStaysWithItsTrack) {
  Room room;
  room.see_often({view(1, 0, 0), view(2, 0, 0)}, 3);
  SensorView head_only = view(2, 0, 0);
  head_only.skeleton[JointId::SpineBase].state = JointState::NotTracked;
  head_only.skeleton[JointId::Neck].state = JointState::NotTracked;
  const auto people = room.see({view(1, 0, 0), head_only});
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].views.size(), 2u);
}

TEST(GroupProperty, TheOrderOfViewsDoesNotMatter) {
  std::vector views{view(1, 0, 0, 1), view(1, 1.5, 0, 2), view(2, 0.1, 0, 4), view(3, 1.4, 0, 9)};
  std::sort(views.begin(), views.end(),
            [](const auto& a, const auto& b) { return a.body < b.body; });
  Room first;
  const auto expected = first.see_often(views, 3);
  do {
    Room room;
    const auto people = room.see_often(views, 3);
    ASSERT_EQ(people.size(), expected.size());
    for (std::size_t i = 0; i < people.size(); ++i) {
      EXPECT_EQ(people[i].id, expected[i].id);
      ASSERT_EQ(people[i].views.size(), expected[i].views.size());
      EXPECT_EQ(people[i].views[0].body, expected[i].views[0].body);
    }
  } while (std::next_permutation(views.begin(), views.end(),
                                 [](const auto& a, const auto& b) { return a.body < b.body; }));
}

TEST(Group, LiarsDoNotFillTheRoom) {
  Room room;
  std::vector<SensorView> views;
  for (std::uint64_t i = 0; i < 64; ++i) {
    views.push_back(view(1, 100 + 5.0 * static_cast<double>(i), 0, i + 1));
    views.push_back(view(2, 5.0 * static_cast<double>(i), 500, i + 1));
  }
  for (const SensorView& honest : {view(3, 0, 0), view(4, 0, 0)}) views.push_back(honest);
  const auto people = room.see_often(views, 3);
  EXPECT_EQ(people.size(), 64u);
  EXPECT_TRUE(std::any_of(people.begin(), people.end(),
                          [](const Person& person) { return person.views.size() == 2; }));
  EXPECT_LE(room.tracks.people.size(), 256u);
}

}  // namespace
}  // namespace chorus::associate
