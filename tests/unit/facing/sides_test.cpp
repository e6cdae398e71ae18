#include "fusion-server/facing/sides.h"

#include <chrono>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/facing/posed_body.h"

namespace chorus::facing {
namespace {

constexpr Timestamp kStart = from_unix_ns(1'790'000'000'000'000'000);
constexpr Duration kFrame = std::chrono::milliseconds(33);
constexpr double kSidesStep = 0.033;  // [s]

/// The habits that real trackers have shown; the model contains none of them.
const std::vector<std::vector<Flips>> kTrackers{
    {{deg(130), deg(100)}},         {{deg(130), deg(75)}},         {{deg(130), deg(55)}},
    {{deg(110), deg(70)}},          {{deg(97), deg(92)}},          {{deg(140), deg(40)}},
    {{deg(150), deg(120)}},         {{deg(95), deg(95)}},          {kNever},
    {{deg(130), deg(100)}, kNever}, {{deg(130), deg(55)}, kNever}, {{deg(97), deg(92)}, kNever},
};

/// Fraction of the instants with a wrong view, during `seconds` in a ring; `heading` and `posture`
/// give the person's state at each time.
template <class Heading, class PostureAt>
double wrong_share(Ring ring, double seconds, const Heading& heading, const PostureAt& posture) {
  SidesMemory memory;
  int wrong = 0;
  int all = 0;
  for (double t = 0.0; t < seconds; t += kSidesStep, ++all) {
    const auto exact = body_at({0, 0, 0}, heading(t), posture(t));
    Person person = ring.look(exact, heading(t));
    resolve_sides(person, kStart + from_seconds(t), memory, {});
    wrong += std::ranges::all_of(person.views, [&](const auto& v) { return is_right(v, exact); })
                 ? 0
                 : 1;
  }
  return static_cast<double>(wrong) / all;
}

TEST(Sides, OfAViewFromBehindAreExchangedBackByTheOthers) {
  const auto exact = body_at({0, 0, 0}, 0);
  Person person{PersonId{1},
                {view_from(1, deg(0), exact), view_from(2, deg(60), exact),
                 view_from(3, deg(180), exchanged(exact)), view_from(4, deg(-110), exact)}};
  SidesMemory memory;
  resolve_sides(person, kStart, memory, {});
  for (const SensorView& view : person.views)
    EXPECT_TRUE(is_right(view, exact)) << view.sensor.str();
  EXPECT_NEAR(person.views[0].facing, 0, 1e-9);
  EXPECT_NEAR(person.views[1].facing, deg(-60), 1e-9);
  EXPECT_NEAR(std::abs(person.views[2].facing), deg(180), 1e-9);
}

TEST(Sides, AreRememberedAsTheMeanOfTheViewsInMetres) {
  const auto exact = body_at({0, 0, 0}, 0);
  Person person{PersonId{1}, {view_from(1, deg(0), exact), view_from(2, deg(60), exact)}};
  SidesMemory memory;
  for (int i = 0; i < 10; ++i) resolve_sides(person, kStart + i * kFrame, memory, {});
  const Spans& spans = memory.people.at(PersonId{1}).spans;
  const Spans truth = spans_of(exact);
  for (std::size_t i = 0; i < spans.size(); ++i) EXPECT_LT((spans[i] - truth[i]).norm(), 1e-6) << i;
}

TEST(Sides, AnExchangedViewLosesItsOrientationsTheOthersKeepThem) {
  const auto exact = body_at({0, 0, 0}, 0);
  Person person{PersonId{1},
                {view_from(1, deg(0), exact), view_from(2, deg(110), exact),
                 view_from(3, deg(180), exchanged(exact))}};
  SidesMemory memory;
  resolve_sides(person, kStart, memory, {});
  EXPECT_TRUE(is_unit(person.views[0].skeleton[JointId::Neck].orientation));
  EXPECT_FALSE(is_unit(person.views[2].skeleton[JointId::Neck].orientation));
}

TEST(Sides, StayWhileSomebodyTurnsRoundBeforeASingleSensorWhereverItExchangesThem) {
  for (const auto& flips : kTrackers) {
    for (const double speed : {deg(30), deg(80), deg(180)}) {
      const auto turning = [&](double t) { return wrap_angle(speed * t); };
      EXPECT_EQ(wrong_share(Ring({0.0}, flips), 15, turning, [](double) { return kPlank; }), 0.0)
          << to_deg(flips[0].out) << " " << to_deg(flips[0].back) << " " << to_deg(speed);
    }
  }
}

TEST(Sides, StayWhileSomebodyTurnsRoundBetweenSensorsWhereverTheyExchangeThem) {
  const auto turning = [](double t) { return wrap_angle(deg(80) * t); };
  const auto at_work = [](double) { return kAtWork; };
  for (const auto& flips : kTrackers) {
    EXPECT_EQ(wrong_share(Ring({0.0, deg(90)}, flips), 15, turning, at_work), 0.0)
        << to_deg(flips[0].out) << " " << to_deg(flips[0].back);
    EXPECT_EQ(wrong_share(Ring(kSix, flips), 15, turning, at_work), 0.0)
        << to_deg(flips[0].out) << " " << to_deg(flips[0].back);
  }
}

TEST(Sides, AreRightFromTheFirstFrameOfSomebodyWhoStandsAtWork) {
  for (const auto& flips : kTrackers) {
    for (double heading = 0.0; heading < 2.0 * std::numbers::pi; heading += deg(20)) {
      const auto standing = [&](double) { return wrap_angle(heading); };
      EXPECT_EQ(wrong_share(Ring(kSix, flips), 1, standing, [](double) { return kAtWork; }), 0.0)
          << to_deg(flips[0].out) << " " << to_deg(flips[0].back) << " " << to_deg(heading);
    }
  }
}

TEST(Sides, OutlastHandsBehindTheBack) {
  const auto standing = [](double) { return deg(30); };
  const auto hands = [](double t) {
    return t < 3 ? kAtWork : Posture{.knees = 0.01, .wrists = -0.22, .elbows = -0.02};
  };
  EXPECT_EQ(wrong_share(Ring(kSix, {{deg(130), deg(55)}}), 30, standing, hands), 0.0);
  EXPECT_EQ(wrong_share(Ring({0.0}, {{deg(130), deg(55)}}), 30, standing, hands), 0.0);
}

/// By labels alone, a body seen by sensors that swap sides cannot be distinguished from its mirror
/// image; sensors that never swap them settle it at once.
TEST(Sides, OfAPlankAreToldBySensorsThatLabelRight) {
  for (double heading = 0.0; heading < 2.0 * std::numbers::pi; heading += deg(20)) {
    const auto standing = [&](double) { return wrap_angle(heading); };
    const auto plank = [](double) { return kPlank; };
    EXPECT_EQ(wrong_share(Ring(kSix, {kNever}), 1, standing, plank), 0.0) << to_deg(heading);
  }
}

/// A person walks in front of one sensor that swaps the sides of everybody seen from behind.
TEST(Sides, WalkingForwardsPutsAWrongBeginningRight) {
  SidesMemory memory;
  bool right = false;
  for (int i = 0; i < 90; ++i) {
    const auto exact = body_at({0, 0, -0.033 * i}, deg(180));
    Person person{PersonId{1}, {view_from(1, 0, exchanged(exact))}};
    resolve_sides(person, kStart + i * kFrame, memory, {});
    right = is_right(person.views[0], exact);
    if (i == 0) {
      EXPECT_FALSE(right);
    }  // at first it stands like a plank, and the sensor shows it as facing
  }
  EXPECT_TRUE(right);
  const auto exact = body_at({0, 0, -3}, deg(180));
  Person standing{PersonId{1}, {view_from(1, 0, exchanged(exact))}};
  resolve_sides(standing, kStart + 90 * kFrame, memory, {});
  EXPECT_TRUE(is_right(standing.views[0], exact));
}

TEST(Sides, OfSomebodyWhoWalksBackwardsFromTheFirstFrameFollowThePosture) {
  SidesMemory memory;
  Ring ring(kSix, {{deg(130), deg(55)}});
  for (int i = 0; i < 58; ++i) {  // 1.9 s
    const auto exact = body_at({0, 0, -0.5 + 0.018 * i}, deg(180), {0.06, 0.08, -0.03, 0.03});
    Person person = ring.look(exact, deg(180));
    resolve_sides(person, kStart + i * kFrame, memory, {});
    ASSERT_TRUE(is_right(person.views[0], exact)) << i;
  }
}

TEST(Sides, OfSensorsThatLabelThemselvesStandAlsoWhenSomebodyWalksBackwards) {
  SidesMemory memory;
  for (int i = 0; i < 100; ++i) {
    const auto exact = body_at({0, 0, -0.033 * i}, 0);
    Person person{PersonId{1}, {}};
    for (int s = 0; s < 6; ++s) person.views.push_back(view_from(s, deg(60) * s, exact));
    resolve_sides(person, kStart + i * kFrame, memory, {});
    for (const SensorView& view : person.views) ASSERT_TRUE(is_right(view, exact)) << i;
  }
}

TEST(Sides, AreLeftAloneWhenNotAskedFor) {
  const auto exact = body_at({0, 0, 0}, 0);
  Person person{PersonId{1}, {view_from(1, 0, exact), view_from(2, 0, exchanged(exact))}};
  SidesMemory memory;
  resolve_sides(person, kStart, memory, {.resolve = false});
  EXPECT_FALSE(is_right(person.views[1], exact));
  EXPECT_TRUE(std::isnan(person.views[0].facing));
  EXPECT_TRUE(memory.people.empty());
}

TEST(Sides, AreKeptThroughAnInstantInWhichNobodyCanTell) {
  SidesMemory memory;
  const auto exact = body_at({0, 0, 0}, deg(90));
  Person person{PersonId{1}, {view_from(1, 0, exact)}};
  resolve_sides(person, kStart, memory, {});
  auto narrow = exact;  // between front and rear the tracker moves both sides to the middle
  for (const auto& [left, right] : kMirrorPairs) {
    narrow[left].position = narrow[right].position =
        0.5 * (exact[left].position + exact[right].position);
  }
  Person between{PersonId{1}, {view_from(1, 0, narrow)}};
  resolve_sides(between, kStart + kFrame, memory, {});
  Person flipped{PersonId{1}, {view_from(1, 0, exchanged(exact))}};
  resolve_sides(flipped, kStart + 2 * kFrame, memory, {});
  Person later{PersonId{1}, {view_from(1, 0, exchanged(exact))}};
  resolve_sides(later, kStart + 3 * kFrame, memory, {});
  EXPECT_TRUE(is_right(later.views[0], exact));
}

/// Joints interpolated between two bodies.
Skeleton<WorldSpace> between(const Skeleton<WorldSpace>& a, const Skeleton<WorldSpace>& b,
                             double share) {
  Skeleton<WorldSpace> body = a;
  for (std::size_t i = 0; i < kJointCount; ++i)
    body.joints[i].position += share * (b.joints[i].position - a.joints[i].position);
  return body;
}

/// A tracker shows a body that faces 65 deg until it takes the back for the front; then it shows
/// one that faces 120 deg, with left and right swapped.  In between, for three frames, it moves
/// left and right joints through the middle to the other side.
TEST(Sides, AreNotDraggedAlongByATrackerThatChangesItsMind) {
  const auto front = body_at({0, 0, 0}, deg(65));
  const auto rear = exchanged(body_at({0, 0, 0}, deg(120)));
  for (const bool second : {false, true}) {  // also with a second view that hardly shows sides
    SidesMemory memory;
    const auto narrow = between(front, exchanged(front), 0.45);
    for (int i = 0; i < 30; ++i) {
      const double share = std::clamp((i - 10) / 4.0, 0.0, 1.0);
      Person person{PersonId{1}, {view_from(1, 0, between(front, rear, share))}};
      if (second) person.views.push_back(view_from(2, 0, narrow));
      resolve_sides(person, kStart + i * kFrame, memory, {});
      if (share == 1.0) {
        EXPECT_TRUE(is_right(person.views[0], body_at({0, 0, 0}, deg(120)))) << i;
      }
    }
  }
}

/// A person at work turns in front of a camera that never swaps sides.  Then a flat body ("plank")
/// appears, turned by 150 deg from facing the camera.  Its sides are more certain than with a
/// camera whose habit is unknown.
TEST(Sides, OfALaterPersonAreToldByTheHabitThatAnEarlierOneTaught) {
  const auto plank = body_at({0, 0, 0}, deg(150));
  const auto first_odds = [&](const SidesMemory& from) {
    SidesMemory memory = from;
    Person person{PersonId{2}, {view_from(0, 0, plank)}};
    resolve_sides(person, kStart + std::chrono::seconds(40), memory, {});
    const double right = memory.people.at(PersonId{2}).filter.right();
    return is_right(person.views[0], plank) ? right : 1.0 - right;
  };
  SidesMemory memory;
  Ring ring({0.0}, {kNever});
  for (double t = 0.0; t < 30.0; t += kSidesStep) {
    const double heading = wrap_angle(deg(40) * t);
    Person person = ring.look(body_at({0, 0, 0}, heading, kAtWork), heading);
    resolve_sides(person, kStart + from_seconds(t), memory, {});
  }
  EXPECT_GT(first_odds(memory), first_odds({}) + 0.005);
}

/// Somebody turns between sensors, and then their sides slip, as when limbs cross in a jump.  The
/// posture is no evidence here; only the labels are.
bool right_after_a_slip(const std::vector<Flips>& flips) {
  SidesMemory memory;
  Ring ring(kSix, flips);
  const auto instant = [&](double t, double heading, const Posture& posture) {
    const auto exact = body_at({0, 0, 0}, heading, posture);
    Person person = ring.look(exact, heading);
    resolve_sides(person, kStart + from_seconds(t), memory, {});
    return std::ranges::all_of(person.views, [&](const auto& v) { return is_right(v, exact); });
  };
  double t = 0.0;
  for (; t < 10.0; t += kSidesStep) instant(t, wrap_angle(deg(80) * t), kAtWork);
  for (Eigen::Vector3d& span : memory.people.at(PersonId{1}).spans) span = -span;
  bool right = false;
  for (const double end = t + 2.0; t < end; t += kSidesStep) right = instant(t, 0.0, kPlank);
  return right;
}

TEST(Sides, ThatSlippedArePutRightBySensorsThatTellFrontFromRear) {
  EXPECT_TRUE(right_after_a_slip({kNever}));
  EXPECT_TRUE(right_after_a_slip({kNever, {deg(130), deg(55)}}));
  EXPECT_FALSE(right_after_a_slip({{deg(130), deg(55)}}));
}

/// The body with the joints of both sides drawn towards the spine, as by a tracker that changes its
/// labels.
Skeleton<WorldSpace> drawn_together(Skeleton<WorldSpace> body, double share) {
  for (const auto& [left, right] : kMirrorPairs) {
    const Eigen::Vector3d middle = 0.5 * (body[left].position + body[right].position);
    for (const JointId id : {left, right})
      body[id].position = middle + share * (body[id].position - middle);
  }
  return body;
}

TEST(Sides, AreFollowedThroughAChangeOfLabelsOfTwoOppositeSensors) {
  SidesMemory memory;
  for (double heading = deg(60); heading < deg(180); heading += deg(200) * kSidesStep) {
    const auto exact = body_at({0, 0, 0}, heading, kAtWork);
    const bool changing = std::abs(heading - deg(120)) < deg(12);
    const auto shown = drawn_together(exact, changing ? 0.05 : 1.0);
    const bool changed = heading > deg(120);
    Person person{PersonId{1},
                  {view_from(1, 0, changed ? exchanged(shown) : shown),
                   view_from(2, deg(180), changed ? shown : exchanged(shown))}};
    resolve_sides(person, kStart + from_seconds(heading / deg(200)), memory, {});
    for (const SensorView& view : person.views)
      EXPECT_GT(agreement(spans_of(view.skeleton), spans_of(exact)), 0.0) << to_deg(heading);
  }
}

TEST(Sides, AreLessCertainAfterALeapToTheSideThanAfterASlightTurn) {
  const auto lost_by = [](double turn) {
    SidesMemory memory;
    const auto confidence = [&](int i, double heading) {
      const auto exact = body_at({0, 0, 0}, heading, kAtWork);
      Person person{PersonId{1}, {view_from(1, 0, exact), view_from(2, deg(60), exact)}};
      resolve_sides(person, kStart + i * kFrame, memory, {});
      return *person.sides_confidence;
    };
    for (int i = 0; i < 30; ++i) (void)confidence(i, 0);
    const double before = confidence(30, 0);
    return before - confidence(31, turn);
  };
  EXPECT_LT(lost_by(deg(30)), 0.001);
  EXPECT_GT(lost_by(deg(85)), 0.05);
}

TEST(Sides, AreNotTurnedByAKickAcross) {
  SidesMemory memory;
  for (int i = 0; i < 60; ++i) {
    auto exact = body_at({0, 0, 0}, 0);
    if (i >= 30 && i < 36) {
      exact[JointId::AnkleLeft].position.x() = -0.5;
      exact[JointId::AnkleRight].position.x() = 0.5;
    }
    Person person{PersonId{1}, {view_from(1, 0, exact), view_from(2, deg(60), exact)}};
    resolve_sides(person, kStart + i * kFrame, memory, {});
    for (const SensorView& view : person.views) ASSERT_TRUE(is_right(view, exact)) << i;
  }
}

/// Sides are held as firmly after a reversal as when they were first found.
TEST(Sides, ThatTurnedRoundStayWithTheirPosture) {
  SidesMemory memory;
  const auto upright = body_at({0, 0, 0}, deg(180));
  const auto at_work = body_at({0, 0, 0}, deg(180), kAtWork);
  const auto odds = [&](const Skeleton<WorldSpace>& body, int frame) {
    Person person{PersonId{1}, {view_from(1, 0, exchanged(body))}};
    resolve_sides(person, kStart + frame * kFrame, memory, {});
    const double right = memory.people.at(PersonId{1}).filter.right();
    return is_right(person.views[0], body) ? std::log(right / (1.0 - right)) : -1.0;
  };
  EXPECT_LT(odds(upright, 0), 0.0);  // assumed to face the sensor
  for (int i = 1; i < 150; ++i) odds(at_work, i);
  const double settled = odds(at_work, 150);
  EXPECT_GT(settled, 1.0);
  EXPECT_NEAR(odds(at_work, 151), settled, 0.1);
}

TEST(Sides, BeginAnewAfterALongAbsence) {
  SidesMemory memory;
  const auto exact = body_at({0, 0, 0}, 0);
  Person person{PersonId{1}, {view_from(1, 0, exact)}};
  resolve_sides(person, kStart, memory, {});
  Person later{PersonId{1}, {view_from(1, 0, exchanged(exact))}};
  resolve_sides(later, kStart + std::chrono::seconds(2), memory, {});
  EXPECT_FALSE(is_right(later.views[0], exact));  // a single sensor is believed at first
}

TEST(Sides, OfABodyWithoutPairsOrWithoutViewsAreNothing) {
  SidesMemory memory;
  Person nobody{PersonId{1}, {}};
  resolve_sides(nobody, kStart, memory, {});
  Person blank{PersonId{2}, {view_from(1, 0, {})}};
  resolve_sides(blank, kStart, memory, {});
  resolve_sides(blank, kStart + kFrame, memory, {});
  EXPECT_EQ(memory.people.at(PersonId{2}).filter.right(), 0.5);
  EXPECT_TRUE(std::isnan(blank.views[0].facing));
}

}  // namespace
}  // namespace chorus::facing
