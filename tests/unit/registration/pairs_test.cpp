#include "fusion-server/registration/pairs.h"

#include <algorithm>
#include <bit>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/unit/registration/walk_builder.h"

namespace chorus::registration {
namespace {

constexpr Duration kFrame = std::chrono::milliseconds(33);

TrailFrame frame_at(Duration after, const Eigen::Vector3d& neck, std::uint64_t body = 1) {
  TrailFrame frame;
  frame.captured = kWalkStart + after;
  frame.body = BodyId{body};
  frame.points[0] = neck;
  frame.seen = 1;
  return frame;
}

Trail trail_with(std::vector<TrailFrame> frames) { return {sensor(1), std::move(frames)}; }

RegistrationConfig neck_only() {
  RegistrationConfig config;
  config.joints = JointChoice::Neck;
  return config;
}

TEST(TrailReader, InterpolatesBetweenFramesAndNeverBeyond) {
  const Trail trail =
      trail_with({frame_at(Duration{0}, {0, 1, 2}), frame_at(kFrame, {0.033, 1, 2})});
  TrailReader reader(trail, kFrame);
  EXPECT_FALSE(reader.at(kWalkStart - kFrame));
  const auto exact = reader.at(kWalkStart);
  ASSERT_TRUE(exact);
  EXPECT_EQ(exact->frame.points[0], Eigen::Vector3d(0, 1, 2));
  EXPECT_EQ(exact->speed, 0.0);
  const auto between = reader.at(kWalkStart + kFrame / 3);
  ASSERT_TRUE(between);
  EXPECT_NEAR(between->frame.points[0].x(), 0.011, 1e-6);
  EXPECT_EQ(between->frame.captured, kWalkStart + kFrame / 3);
  EXPECT_NEAR(between->speed, 1.0, 1e-6);
  EXPECT_TRUE(reader.at(kWalkStart + kFrame));
  EXPECT_FALSE(reader.at(kWalkStart + 2 * kFrame));
}

TEST(TrailOf, MarksTheFramesAtWhichThePersonHadMoved) {
  const WalkSpec still{
      .path = [](double) { return Eigen::Vector2d(0.2, 0.1); }, .length = 2, .noise = 0.001};
  const Trail resting = trail_of(watch(1, ring_place(0), still), JointChoice::Core);
  const Trail walking = trail_of(watch(1, ring_place(0), {.length = 2}), JointChoice::Core);
  const auto moved = [](const Trail& trail) {
    return std::ranges::count_if(trail.frames, &TrailFrame::moved);
  };
  ASSERT_EQ(resting.frames.size(), walking.frames.size());
  EXPECT_LT(moved(resting), 12);  // the person turns and bobs by 20 mm
  EXPECT_GT(moved(walking), 40);
  const Trail other = trail_of(watch(2, ring_place(1), still), JointChoice::Core);
  const Pairing pairing = pair_up(other, resting, {});
  EXPECT_GT(pairing.resting, pairing.together / 2);
  EXPECT_LE(pairing.instants, static_cast<std::size_t>(moved(resting)));
}

TEST(TrailReader, RefusesWideGapsAndOtherBodies) {
  const Trail trail = trail_with({frame_at(Duration{0}, {0, 1, 2}), frame_at(2 * kFrame, {0, 1, 2}),
                                  frame_at(3 * kFrame, {0, 1, 2}, 2)});
  TrailReader narrow(trail, 2 * kFrame - Duration{1});
  EXPECT_FALSE(narrow.at(kWalkStart + kFrame));
  TrailReader wide(trail, 2 * kFrame);
  EXPECT_TRUE(wide.at(kWalkStart + kFrame));
  // Between the last two frames the sensor changes to another body, so nothing is interpolated
  // there.
  EXPECT_FALSE(wide.at(kWalkStart + 2 * kFrame + kFrame / 2));
  EXPECT_TRUE(wide.at(kWalkStart + 3 * kFrame));
}

TEST(TrailReader, ASlotNeedsBothEnds) {
  TrailFrame later = frame_at(kFrame, {0, 1, 2});
  later.points[1] = {0, 2, 2};
  later.seen = 3;
  const Trail trail = trail_with({frame_at(Duration{0}, {0, 1, 2}), later});
  TrailReader reader(trail, kFrame);
  const auto between = reader.at(kWalkStart + kFrame / 2);
  ASSERT_TRUE(between);
  EXPECT_TRUE(between->frame.has(0));
  EXPECT_FALSE(between->frame.has(1));
}

TEST(PairUp, GivesTheSameInstantOfBothSensors) {
  const WalkSpec exact{.length = 5, .noise = 0.0};
  const Eigen::Isometry3d one = ring_place(0.0);
  const Eigen::Isometry3d two = ring_place(1.2);
  const Trail target = trail_of(watch(1, one, exact), JointChoice::Core);
  const Trail source = trail_of(watch(2, two, exact), JointChoice::Core);
  const Pairing pairing = pair_up(target, source, {});
  EXPECT_GT(pairing.pairs.size(), 800u);
  EXPECT_EQ(pairing.pairs.size(), 8 * pairing.instants);
  for (const Pair& pair : pairing.pairs) {
    EXPECT_LT((one * pair.x_in_target - two * pair.x_in_source).norm(), mm(2));
    EXPECT_NEAR(pair.ray_in_target.dot(pair.x_in_target), pair.x_in_target.norm(), 1e-9);
    EXPECT_NEAR(pair.ray_in_source.dot(pair.x_in_source), pair.x_in_source.norm(), 1e-9);
    EXPECT_NEAR(pair.sigma, std::numbers::sqrt2 * slots_of(JointChoice::Core)[pair.slot].sigma,
                1e-12);
  }
}

TEST(PairUp, SwappedSensorsGiveThePairsMirrored) {
  std::vector<TrailFrame> there;
  std::vector<TrailFrame> here;
  for (int i = 0; i < 5; ++i) {
    there.push_back(frame_at(i * kFrame, {0.01 * i, 1, 2}));
    here.push_back(frame_at(i * kFrame, {0.01 * i, 1, 3}));
  }
  const Pairing forth = pair_up(trail_with(there), trail_with(here), neck_only());
  const Pairing back = pair_up(trail_with(here), trail_with(there), neck_only());
  ASSERT_EQ(forth.pairs.size(), 5u);
  ASSERT_EQ(back.pairs.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(forth.pairs[i].x_in_target, back.pairs[i].x_in_source);
    EXPECT_EQ(forth.pairs[i].instant, i);
  }
}

TEST(PairUp, CountsWhatItLeavesOutAndWhy) {
  std::vector<TrailFrame> standing;
  std::vector<TrailFrame> running;
  for (int i = 0; i < 10; ++i) {
    standing.push_back(frame_at(i * kFrame + kFrame / 2, {0, 1, 3}));
    running.push_back(frame_at(i * kFrame, {0.1 * i, 1, 3}));  // 3 m/s
  }
  const Pairing fast = pair_up(trail_with(running), trail_with(standing), neck_only());
  EXPECT_EQ(fast.together, 9u);
  EXPECT_EQ(fast.too_fast, 9u);
  EXPECT_TRUE(fast.pairs.empty());
  for (TrailFrame& frame : standing) frame.points[0] = {0, 0, 6.1};
  const Pairing far = pair_up(trail_with(standing), trail_with(standing), neck_only());
  EXPECT_EQ(far.out_of_range, 10u);
  for (TrailFrame& frame : standing) frame.points[0] = {0, 0, 0.4};
  EXPECT_EQ(pair_up(trail_with(standing), trail_with(standing), neck_only()).out_of_range, 10u);
  for (TrailFrame& frame : standing) frame.points[0] = {0, 0, 5.9};
  EXPECT_EQ(pair_up(trail_with(standing), trail_with(standing), neck_only()).pairs.size(), 10u);
}

TEST(PairUp, NobodyInCommonIsNothing) {
  const Trail early = trail_with({frame_at(Duration{0}, {0, 1, 2})});
  const Trail late = trail_with({frame_at(std::chrono::seconds(9), {0, 1, 2})});
  EXPECT_EQ(pair_up(early, late, neck_only()).together, 0u);
  EXPECT_EQ(pair_up({sensor(1), {}}, late, neck_only()).together, 0u);
  EXPECT_EQ(pair_up(late, {sensor(1), {}}, neck_only()).together, 0u);
}

TEST(TrailOf, MirrorPairsGiveTheSameMiddleWhicheverSideIsLeft) {
  WalkTrack walk = watch(1, ring_place(0), {.length = 1});
  const Trail as_is = trail_of(walk, JointChoice::Core);
  using enum JointId;
  for (SensorFrame& frame : walk.frames) {
    auto& body = frame.bodies[0].skeleton;
    std::swap(body[ShoulderLeft], body[ShoulderRight]);
    std::swap(body[HipLeft], body[HipRight]);
  }
  const Trail flipped = trail_of(walk, JointChoice::Core);
  ASSERT_EQ(as_is.frames.size(), flipped.frames.size());
  for (std::size_t i = 0; i < as_is.frames.size(); ++i) {
    for (std::size_t slot = 0; slot < 6; ++slot) {
      EXPECT_LT((as_is.frames[i].points[slot] - flipped.frames[i].points[slot]).norm(), 1e-12);
    }
  }
}

TEST(TrailOf, TakesTrackedJointsOfALoneBodyInTheOrderOfTime) {
  WalkTrack walk = watch(1, ring_place(0), {.length = 0.5});
  walk.frames[2].bodies.push_back(walk.frames[2].bodies[0]);
  walk.frames[4].bodies[0].skeleton[JointId::Head].state = JointState::Inferred;
  walk.frames[5].bodies[0].skeleton[JointId::HipRight].state = JointState::NotTracked;
  walk.frames[7].captured = walk.frames[6].captured;
  for (Joint& joint : walk.frames[9].bodies[0].skeleton.joints) joint.state = JointState::Inferred;
  const Trail trail = trail_of(walk, JointChoice::Core);
  EXPECT_EQ(trail.sensor, sensor(1));
  ASSERT_EQ(trail.frames.size(), walk.frames.size() - 3);
  EXPECT_FALSE(trail.frames[3].has(2));  // the head was only inferred
  EXPECT_TRUE(trail.frames[3].has(0));
  EXPECT_FALSE(trail.frames[4].has(5));  // a hip pair with one joint does not count
  for (std::size_t i = 1; i < trail.frames.size(); ++i) {
    EXPECT_LT(trail.frames[i - 1].captured, trail.frames[i].captured);
  }
}

TEST(TrailOf, LeavesOutBodiesThatNeverMove) {
  WalkTrack walk = watch(1, ring_place(0), {.length = 4});
  const BodyFrame statue = {BodyId{2}, {}, walk.frames[0].bodies[0].skeleton};
  const std::size_t half = walk.frames.size() / 2;
  for (std::size_t i = 0; i < half; ++i) walk.frames[i].bodies.push_back(statue);
  for (std::size_t i = 0; i < half / 2; ++i)
    walk.frames[i].bodies.erase(walk.frames[i].bodies.begin());
  const Trail trail = trail_of(walk, JointChoice::Core);
  // The person counts although the statue is in view; the statue alone does not.
  EXPECT_EQ(trail.frames.size(), walk.frames.size() - half / 2);
  for (const TrailFrame& frame : trail.frames) EXPECT_EQ(frame.body, BodyId{1});
}

TEST(TrailOf, ABodySeenForLessThanASecondIsNoStatue) {
  WalkTrack walk = watch(1, ring_place(0), {.length = 0.9});
  for (SensorFrame& frame : walk.frames) frame.bodies[0] = walk.frames[0].bodies[0];
  EXPECT_EQ(trail_of(walk, JointChoice::Core).frames.size(), walk.frames.size());
}

TEST(SlotsOf, EveryChoiceStartsWithWhatItPromises) {
  EXPECT_EQ(slots_of(JointChoice::Neck).size(), 1u);
  EXPECT_EQ(slots_of(JointChoice::Core).size(), 8u);
  EXPECT_EQ(slots_of(JointChoice::All).size(), kJointCount);
  EXPECT_EQ(slots_of(JointChoice::Neck)[0].first, JointId::Neck);
  for (const JointChoice choice : {JointChoice::Neck, JointChoice::Core, JointChoice::All}) {
    for (const Slot& slot : slots_of(choice)) EXPECT_GT(slot.sigma, 0.0);
  }
}

}  // namespace
}  // namespace chorus::registration
