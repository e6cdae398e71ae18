// Position errors beside the orientation measure: what each shows of the same faults.
#include "common/evaluation/place_error.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

using inertial::Limb;

void put(Skeleton<WorldSpace>& body, JointId id, const Eigen::Vector3d& place) {
  body[id].position = place;
  body[id].state = JointState::Tracked;
}

/// Somebody's left shank whose knee moves along x, with errors of knee and ankle along z.
Timed<Skeleton<WorldSpace>> shank(double time, double knee_off, double ankle_off) {
  Timed<Skeleton<WorldSpace>> out{time, {}};
  put(out.value, JointId::KneeLeft, {0.2 * time, 0.5, knee_off});
  put(out.value, JointId::AnkleLeft, {0.2 * time, 0.1, ankle_off});
  return out;
}

TEST(PlaceErrors, AreTheMeanOfTheLimbsJointsAtTheTrackersInstants) {
  BodyTrack tracked, reference;
  for (int i = 0; i < 30; ++i) tracked.push_back(shank(i / 30.0, 0.02, 0.04));
  for (int i = 0; i < 100; ++i) reference.push_back(shank(i / 100.0, 0.0, 0.0));
  const Signal errors = place_errors(Limb::ShankLeft, tracked, reference);
  ASSERT_EQ(errors.size(), 30u);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    EXPECT_EQ(errors[i].time, tracked[i].time);
    EXPECT_NEAR(errors[i].value, 0.03, 1e-9);  // interpolated: both move at constant speed
  }
  EXPECT_NEAR(place_errors(Limb::ThighLeft, tracked, reference)[0].value, 0.02, 1e-9);  // knee
  EXPECT_TRUE(place_errors(Limb::ForearmLeft, tracked, reference).empty());
}

TEST(PlaceErrors, AreNotGuessedWhereTheReferenceIsSilent) {
  BodyTrack tracked, reference;
  for (int i = 0; i < 60; ++i) tracked.push_back(shank(i / 30.0, 0.0, 0.0));
  for (int i = 0; i < 200; ++i) {
    if (i > 50 && i < 150) continue;
    reference.push_back(shank(i / 100.0, 0.01, 0.01));
  }
  for (auto& each : reference)
    if (each.time < 0.3) each.value[JointId::AnkleLeft] = {};
  for (const auto& each : place_errors(Limb::ShankLeft, tracked, reference)) {
    EXPECT_TRUE(each.time <= 0.5 || each.time >= 1.5) << each.time;
    EXPECT_NEAR(each.value, 0.01, 1e-9);
  }
  EXPECT_TRUE(place_errors(Limb::ShankLeft, tracked, {}).empty());
  EXPECT_TRUE(place_errors(Limb::ShankLeft, {}, reference).empty());
}

struct Judged {
  RefereedLimb refereed;
  JudgedLimb judged;
  Signal places;
};

/// Noise of some degrees and millimetres; from 4 to 6 s the tracker's limb is wrong by 80 degrees,
/// and its joints by `off` [m].
Judged faulty(double off) {
  Judged out;
  for (int i = 0; i < 300; ++i) {
    const double time = i / 30.0;
    const bool wrong = time >= 4.0 && time <= 6.0;
    const double noise = 0.5 + 0.5 * std::sin(37.0 * time);
    LimbError against_reference;
    against_reference.angle = deg(wrong ? 80.0 : 3.0 + 2.0 * noise);
    out.refereed.tracker.push_back({time, against_reference});
    LimbError against_sensor;
    against_sensor.angle = deg((wrong ? 78.0 : 4.0) + 3.0 * noise);
    out.judged.errors.push_back({time, against_sensor});
    out.places.push_back({time, 0.02 + 0.01 * noise + (wrong ? off : 0.0)});
  }
  out.refereed.limb = out.judged.limb = Limb::ShankLeft;
  return out;
}

TEST(PlacedLimb, ATwistShowsInTheOrientationAndInNoPosition) {
  const Judged one = faulty(0.0);
  const PlacedLimb placed = placed_limb(one.refereed, one.judged, one.places, kPaperTau);
  ASSERT_EQ(placed.faults.size(), 1u);
  EXPECT_NEAR(placed.faults[0].begin, 4.0, 0.05);
  EXPECT_NEAR(placed.faults[0].end, 6.0, 0.1);
  ASSERT_TRUE(placed.angle.area && placed.place.area);
  EXPECT_NEAR(*placed.angle.area, 1.0, 1e-6);
  EXPECT_NEAR(*placed.place.area, 0.5, 0.06);
  EXPECT_GT(placed.angle.inside, deg(70));
  EXPECT_LT(placed.angle.outside, deg(10));
  EXPECT_NEAR(placed.place.inside, placed.place.outside, 0.003);
  EXPECT_NEAR(placed.spread.median, 0.025, 0.003);
}

TEST(PlacedLimb, ASwingShowsInBoth) {
  const Judged one = faulty(0.2);
  const PlacedLimb placed = placed_limb(one.refereed, one.judged, one.places, kPaperTau);
  EXPECT_NEAR(placed.place.area.value_or(0.0), 1.0, 1e-6);
  EXPECT_NEAR(placed.place.inside - placed.place.outside, 0.2, 0.005);
}

TEST(PlacedLimb, ComparesBothMeasuresAtInstantsThatTheRefereeJudged) {
  Judged one = faulty(0.0);
  one.places.insert(one.places.begin(), {-1.0, 9.0});
  std::erase_if(one.refereed.tracker, [](const auto& each) { return each.time > 3.0; });
  const PlacedLimb placed = placed_limb(one.refereed, one.judged, one.places, kPaperTau);
  EXPECT_EQ(placed.errors.size(), one.refereed.tracker.size());
  EXPECT_TRUE(placed.faults.empty());
  EXPECT_FALSE(placed.angle.area);  // no fault: nothing to tell
  EXPECT_FALSE(placed.place.area);
  const PlacedLimb nothing = placed_limb({}, {}, {}, kPaperTau);
  EXPECT_TRUE(nothing.errors.empty());
  EXPECT_EQ(nothing.spread.median, 0.0);
}

}  // namespace
}  // namespace chorus::evaluation
