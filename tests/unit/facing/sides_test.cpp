#include "fusion-server/facing/sides.h"

#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::facing {
namespace {

constexpr Timestamp kStart = from_unix_ns(1'790'000'000'000'000'000);
constexpr Duration kFrame = std::chrono::milliseconds(33);

/// A person at `place` who faces yaw `heading` (0: +z); left is +x then.
Skeleton<WorldSpace> body_at(const Eigen::Vector3d& place, double heading) {
  Skeleton<WorldSpace> body;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    double side = 0.0;
    for (const auto& [left, right] : kMirrorPairs) {
      side += id == left ? 0.2 : 0.0;
      side -= id == right ? 0.2 : 0.0;
    }
    const Eigen::Vector3d in_body(side, 0.06 * static_cast<double>(i), 0);
    body.joints[i].position = place + about_y(heading) * in_body;
    body.joints[i].orientation = about_y(heading);
    body.joints[i].state = JointState::Tracked;
  }
  return body;
}

Skeleton<WorldSpace> exchanged(Skeleton<WorldSpace> body) {
  for (const auto& [left, right] : kMirrorPairs) std::swap(body[left], body[right]);
  return body;
}

/// Seen by sensor `number`, 3 m away in the direction of yaw `from`.
SensorView view_from(int number, double from, const Skeleton<WorldSpace>& body) {
  SensorView view;
  view.sensor = SensorId::parse("s" + std::to_string(number)).value();
  view.eye = 3.0 * Eigen::Vector3d(std::sin(from), 0.5, std::cos(from));
  view.skeleton = body;
  return view;
}

/// Left shoulder truly on the left?
bool is_right(const SensorView& view, const Skeleton<WorldSpace>& exact) {
  const auto& shown = view.skeleton[JointId::ShoulderLeft].position;
  return (shown - exact[JointId::ShoulderLeft].position).norm() < 0.1;
}

TEST(Sides, OfAViewFromBehindAreExchangedBackByTheOthers) {
  const auto exact = body_at({0, 0, 0}, 0);
  Person person{PersonId{1},
                {view_from(1, deg(0), exact), view_from(2, deg(60), exact),
                 view_from(3, deg(180), exchanged(exact)), view_from(4, deg(-110), exact)}};
  SidesMemory memory;
  resolve_sides(person, {kStart}, memory, {});
  for (const SensorView& view : person.views)
    EXPECT_TRUE(is_right(view, exact)) << view.sensor.str();
  EXPECT_NEAR(person.views[0].facing, 0, 1e-9);
  EXPECT_NEAR(person.views[1].facing, deg(-60), 1e-9);
  EXPECT_NEAR(std::abs(person.views[2].facing), deg(180), 1e-9);
}

TEST(Sides, AnExchangedViewLosesItsOrientationsTheOthersKeepThem) {
  const auto exact = body_at({0, 0, 0}, 0);
  Person person{PersonId{1},
                {view_from(1, deg(0), exact), view_from(2, deg(110), exact),
                 view_from(3, deg(180), exchanged(exact))}};
  SidesMemory memory;
  resolve_sides(person, {kStart}, memory, {});
  EXPECT_TRUE(is_unit(person.views[0].skeleton[JointId::Neck].orientation));
  EXPECT_FALSE(is_unit(person.views[2].skeleton[JointId::Neck].orientation));
}

/// Where a tracker exchanges left and right of somebody who turns away, and where it takes that
/// back. Real ones differ, and none of them is the model that `exchange_at` describes.
struct Flips {
  double out = deg(130);
  double back = deg(100);
};

/// Share of the instants with wrong sides while somebody turns round before these sensors.
double wrong_share_of_turning(const Flips& flips, const std::vector<double>& sensors,
                              double speed = deg(80)) {
  SidesMemory memory;
  std::vector<bool> rear(sensors.size(), false);
  int wrong = 0;
  constexpr int kInstants = 400;
  for (int i = 0; i < kInstants; ++i) {
    const double heading = wrap_angle(speed * 0.033 * i);
    const auto exact = body_at({0, 0, 0}, heading);
    Person person{PersonId{1}, {}};
    for (std::size_t s = 0; s < sensors.size(); ++s) {
      const double facing = std::abs(wrap_angle(heading - sensors[s]));
      rear[s] = rear[s] ? facing > flips.back : facing > flips.out;
      person.views.push_back(
          view_from(static_cast<int>(s), sensors[s], rear[s] ? exchanged(exact) : exact));
    }
    resolve_sides(person, {kStart + i * kFrame}, memory, {});
    wrong += is_right(person.views[0], exact) ? 0 : 1;
  }
  return static_cast<double>(wrong) / kInstants;
}

// The model of sides.h (115 deg, give or take 10) is none of these.
constexpr std::array<Flips, 8> kTrackers{{{deg(130), deg(100)},
                                          {deg(140), deg(110)},
                                          {deg(150), deg(120)},
                                          {deg(160), deg(90)},
                                          {deg(125), deg(125)},
                                          {deg(110), deg(110)},
                                          {deg(120), deg(90)},
                                          {deg(130), deg(75)}}};

TEST(Sides, StayWhileSomebodyTurnsRoundBeforeASingleSensorWhereverItExchangesThem) {
  for (const Flips& flips : kTrackers) {
    for (const double speed : {deg(30), deg(80), deg(180)}) {
      EXPECT_EQ(wrong_share_of_turning(flips, {0.0}, speed), 0.0) << to_deg(flips.out);
    }
  }
}

TEST(Sides, StayWhileSomebodyTurnsRoundBetweenSensorsWhereverTheyExchangeThem) {
  const std::vector<double> square{0.0, deg(90)};
  const std::vector<double> ring{0.0, deg(60), deg(120), deg(180), deg(240), deg(300)};
  for (const Flips& flips : kTrackers) {
    EXPECT_EQ(wrong_share_of_turning(flips, square), 0.0) << to_deg(flips.out);
    EXPECT_EQ(wrong_share_of_turning(flips, ring), 0.0) << to_deg(flips.out);
  }
}

/// The other end of Otto's range: labels near the side view tell nothing then.
TEST(Sides, AreLostForAPartOfASlowTurnWhenTheTrackerComesBackLate) {
  EXPECT_LT(wrong_share_of_turning({deg(130), deg(55)}, {0.0}, deg(30)), 0.3);
  EXPECT_EQ(wrong_share_of_turning({deg(130), deg(55)}, {0.0}, deg(80)), 0.0);
}

TEST(Sides, WalkingForwardsPutsAWrongBeginningRight) {
  SidesMemory memory;
  bool right = false;
  for (int i = 0; i < 60; ++i) {  // away from the only sensor, which takes the back for the front
    const auto exact = body_at({0, 0, -0.033 * i}, deg(180));
    Person person{PersonId{1}, {view_from(1, 0, exchanged(exact))}};
    resolve_sides(person, {kStart + i * kFrame, {0, 0, -1.0}}, memory, {});
    right = is_right(person.views[0], exact);
  }
  EXPECT_TRUE(right);
  const auto exact = body_at({0, 0, -2}, deg(180));
  Person standing{PersonId{1}, {view_from(1, 0, exchanged(exact))}};
  resolve_sides(standing, {kStart + 60 * kFrame}, memory, {});
  EXPECT_TRUE(is_right(standing.views[0], exact));
}

TEST(Sides, OfSensorsThatLabelThemselvesStandAlsoWhenSomebodyWalksBackwards) {
  SidesMemory memory;
  const auto exact = body_at({0, 0, 0}, 0);
  for (int i = 0; i < 100; ++i) {
    Person person{PersonId{1}, {}};
    for (int s = 0; s < 6; ++s) person.views.push_back(view_from(s, deg(60) * s, exact));
    resolve_sides(person, {kStart + i * kFrame, {0, 0, -1.0}}, memory, {});
    for (const SensorView& view : person.views) ASSERT_TRUE(is_right(view, exact));
  }
}

TEST(Sides, AreLeftAloneWhenNotAskedFor) {
  const auto exact = body_at({0, 0, 0}, 0);
  Person person{PersonId{1}, {view_from(1, 0, exact), view_from(2, 0, exchanged(exact))}};
  SidesMemory memory;
  resolve_sides(person, {kStart}, memory, {.resolve = false});
  EXPECT_FALSE(is_right(person.views[1], exact));
  EXPECT_TRUE(std::isnan(person.views[0].facing));
  EXPECT_TRUE(memory.empty());
}

TEST(Sides, AreKeptThroughAnInstantInWhichNobodyCanTell) {
  SidesMemory memory;
  const auto exact = body_at({0, 0, 0}, deg(90));
  Person person{PersonId{1}, {view_from(1, 0, exact)}};
  resolve_sides(person, {kStart}, memory, {});
  auto narrow = exact;  // between front and rear the tracker draws the sides together
  for (const auto& [left, right] : kMirrorPairs) {
    narrow[left].position = narrow[right].position =
        0.5 * (exact[left].position + exact[right].position);
  }
  Person between{PersonId{1}, {view_from(1, 0, narrow)}};
  resolve_sides(between, {kStart + kFrame}, memory, {});
  Person flipped{PersonId{1}, {view_from(1, 0, exchanged(exact))}};
  resolve_sides(flipped, {kStart + 2 * kFrame}, memory, {});
  EXPECT_TRUE(is_right(flipped.views[0], exact));
}

TEST(Sides, BeginAnewAfterALongAbsence) {
  SidesMemory memory;
  const auto exact = body_at({0, 0, 0}, 0);
  Person person{PersonId{1}, {view_from(1, 0, exact)}};
  resolve_sides(person, {kStart}, memory, {});
  Person later{PersonId{1}, {view_from(1, 0, exchanged(exact))}};
  resolve_sides(later, {kStart + std::chrono::seconds(2)}, memory, {});
  EXPECT_FALSE(is_right(later.views[0], exact));  // a lone sensor is believed at first
}

TEST(Sides, OfABodyWithoutPairsOrWithoutViewsAreNothing) {
  SidesMemory memory;
  Person nobody{PersonId{1}, {}};
  resolve_sides(nobody, {kStart}, memory, {});
  Person blank{PersonId{2}, {view_from(1, 0, {})}};
  resolve_sides(blank, {kStart}, memory, {});
  resolve_sides(blank, {kStart + kFrame, {1, 0, 0}}, memory, {});
  EXPECT_EQ(memory.at(PersonId{2}).odds, 0.0);
  EXPECT_TRUE(std::isnan(blank.views[0].facing));
}

}  // namespace
}  // namespace chorus::facing
