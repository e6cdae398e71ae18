// People who wear inertial sensors are not taken for others who move otherwise.
#include "fusion-server/associate/worn_likeness.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "common/body/bones.h"
#include "common/evaluation/limb_frame.h"
#include "fusion-server/associate/matching.h"
#include "fusion-server/associate/person_association.h"
#include "tests/support/builders.h"

namespace chorus::associate {
namespace {

using inertial::Limb;

constexpr std::array kArms{Limb::UpperArmLeft, Limb::ForearmLeft, Limb::UpperArmRight,
                           Limb::ForearmRight};

Skeleton<WorldSpace> person_at(double x, bool arms_out) {
  const Eigen::Vector3d place(x, 0, 0);
  return arms_out ? testing::t_pose_person(place) : testing::standing_person(place);
}

std::vector<WornLimb> on_arms(const Skeleton<WorldSpace>& body) {
  std::vector<WornLimb> worn;
  for (const Limb limb : kArms)
    worn.push_back({testing::sensor_id("suit"), limb,
                    evaluation::limb_from_joints(body, limb)->world_from_limb,
                    Eigen::Matrix3d::Zero()});
  return worn;
}

SensorView view_of(const Skeleton<WorldSpace>& body, int sensor, std::uint64_t id) {
  SensorView view;
  view.sensor = testing::sensor_id("s" + std::to_string(sensor));
  view.body = BodyId{id};
  view.skeleton = body;
  view.eye = {0, 1, -3};
  return view;
}

TEST(WornLikeness, TellsTheWearerFromWhoHoldsTheArmsOtherwise) {
  const auto out = person_at(0, true);
  EXPECT_EQ(unlike_worn(view_of(out, 1, 1), on_arms(out)), 0.0);
  EXPECT_GT(unlike_worn(view_of(person_at(0, false), 1, 1), on_arms(out)).value(), 0.9);
  EXPECT_FALSE(unlike_worn(view_of(out, 1, 1), {}));
}

TEST(WornLikeness, SidesThatAViewExchangesDoNotCount) {
  auto out = person_at(0, true);
  const auto worn = on_arms(out);
  for (const auto& [left, right] : kMirrorPairs) std::swap(out[left], out[right]);
  EXPECT_EQ(unlike_worn(view_of(out, 1, 1), worn), 0.0);
}

TEST(WornLikeness, RaysShowItToo) {
  auto down = person_at(0, false);
  SensorView view = view_of(down, 1, 1);
  for (Joint& joint : view.skeleton.joints) {
    joint.position = (joint.position - view.eye).normalized();
    joint.measurement = Measurement::Ray;
  }
  EXPECT_LT(unlike_worn(view, on_arms(down)).value(), 0.1);
  EXPECT_GT(unlike_worn(view, on_arms(person_at(0, true))).value(), 0.9);
}

TEST(WornLikeness, WhereTwoAreAsNearTheSensorsDecide) {
  const auto body = person_at(0, true);
  const auto worn = on_arms(body);
  std::vector<Candidate> both(2);
  for (std::size_t i = 0; i < 2; ++i) {
    both[i].predicted = {0.4 * static_cast<double>(i), 1.2, 0};
    both[i].gate = 0.6;
    both[i].track.admitted = true;
  }
  both[0].worn = worn;
  PlacedView wearer{view_of(person_at(0.21, true), 1, 1), {0.21, 1.2, 0}};
  PlacedView other{view_of(person_at(0.19, false), 1, 2), {0.19, 1.2, 0}};
  EXPECT_TRUE(match({wearer, other}, both).empty());
  ASSERT_EQ(both[0].sights.size(), 1u);
  EXPECT_EQ(both[0].sights[0].view.body, BodyId{1});
}

/// Two people of the same build whom four sensors see; the first wears sensors on the arms.
struct TwoAlike {
  AssociationConfig config = {};
  Tracks tracks = {};
  Timestamp instant = testing::kStart;
  std::uint64_t bodies = 1;
  bool worn = true;

  /// `wearer`, `other`: their places; returns the id at the place of the wearer.
  PersonId see_for(double time, double wearer, double other) {
    std::vector<Person> people;
    for (const Timestamp begun = instant; seconds(instant - begun) < time;) {
      instant += testing::kFrameInterval;
      Scene scene{instant, {}};
      for (int sensor = 0; sensor < 4; ++sensor) {
        scene.views.push_back(view_of(person_at(wearer, true), sensor, bodies));
        scene.views.push_back(view_of(person_at(other, false), sensor, bodies + 1));
      }
      if (worn) scene.worn[PersonId{1}] = on_arms(person_at(wearer, true));
      Grouping grouping = group(std::move(scene), tracks, config);
      tracks = std::move(grouping.tracks);
      people = std::move(grouping.people);
    }
    const auto at = std::ranges::find_if(people, [&](const Person& person) {
      return !person.views.empty() &&
             unlike_worn(person.views.front(), on_arms(person_at(wearer, true))) == 0.0;
    });
    return at == people.end() ? PersonId{} : at->id;
  }
  void look_away(double time) {
    for (const Timestamp begun = instant; seconds(instant - begun) < time;) {
      instant += testing::kFrameInterval;
      Grouping grouping = group({instant, {}}, tracks, config);
      tracks = std::move(grouping.tracks);
    }
    bodies += 2;
  }
};

TEST(WornLikeness, OfTwoAlikeWhoChangedPlacesUnseenBothKeepTheirIds) {
  for (const bool worn : {true, false}) {
    TwoAlike room{.worn = worn};
    ASSERT_EQ(room.see_for(5.0, 0.0, 1.5), PersonId{1});
    room.look_away(0.5);
    EXPECT_EQ(room.see_for(3.0, 1.5, 0.0), worn ? PersonId{1} : PersonId{2});
  }
}

}  // namespace
}  // namespace chorus::associate
