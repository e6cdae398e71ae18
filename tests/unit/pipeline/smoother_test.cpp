// Instants that are fused late know what came after them.
#include "fusion-server/pipeline/smoother.h"

#include <utility>

#include <gtest/gtest.h>

#include "common/body/bones.h"
#include "tests/unit/pipeline/ring.h"

namespace chorus::pipeline {
namespace {

using enum JointId;

constexpr PersonId kPerson{7};
constexpr Duration kFrame = std::chrono::milliseconds(40);

Skeleton<WorldSpace> exchanged(Skeleton<WorldSpace> body) {
  for (const auto& [left, right] : kMirrorPairs) std::swap(body[left], body[right]);
  return body;
}

/// An instant at which two sensors see the person at (x, 0).
Perception seen_at(int index, double x, bool wrong = false) {
  Perception now;
  now.in = {kStart + index * kFrame, kStart + index * kFrame, static_cast<std::uint64_t>(index)};
  now.sensors = {sensor(0), sensor(1)};
  Person person;
  person.id = kPerson;
  for (int i = 0; i < 2; ++i) {
    SensorView view;
    view.sensor = sensor(i);
    view.eye = ring_place(i, 2).translation();
    view.skeleton = wrong ? exchanged(body_at(x, 0)) : body_at(x, 0);
    person.views.push_back(std::move(view));
  }
  now.people = {person};
  now.tracked = {kPerson};
  return now;
}

PipelineConfig waiting(const SmoothingConfig& smoothing) {
  PipelineConfig config;
  config.smoothing = smoothing;
  return config;
}

/// What a Smoother makes of `count` instants.
std::vector<Step> smoothed(const std::vector<Perception>& seen, const SmoothingConfig& smoothing) {
  const PipelineConfig config = waiting(smoothing);
  Smoother smoother;
  std::vector<Step> all;
  for (const Perception& each : seen) {
    for (Step& step : smoother.take(each, config)) all.push_back(std::move(step));
  }
  for (Step& step : smoother.finish(config)) all.push_back(std::move(step));
  return all;
}

/// Somebody whose sides are held the wrong way round for 20 of 40 instants, until they are turned
/// round.
std::vector<Perception> noticed_late() {
  std::vector<Perception> seen;
  facing::PersonFilter filter{facing::PersonPrior{}};
  for (int i = 0; i < 40; ++i) {
    const bool turns = i == 20;
    seen.push_back(seen_at(i, 0.01 * i, i < 20));
    filter.predict(0.04, false, {});
    filter.update({.news = i < 20 ? 0.02 : turns ? -6.0 : 0.5});
    if (turns) filter.turn_round();
    seen.back().sides[kPerson] = filter.step();
  }
  return seen;
}

double off(const Step& step, double x) {
  const Joint& wrist = step.snapshot.bodies.front().skeleton[WristLeft];
  return (wrist.position - body_at(x, 0)[WristLeft].position).norm();
}

TEST(Smoother, PutsRightTheSidesOfInstantsBeforeTheyWereTurnedRound) {
  const auto steps = smoothed(noticed_late(), {});
  ASSERT_EQ(steps.size(), 40u);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    ASSERT_EQ(steps[i].snapshot.bodies.size(), 1u);
    EXPECT_LT(off(steps[i], 0.01 * static_cast<double>(i)), 0.05) << i;
    EXPECT_GT(steps[i].snapshot.bodies[0].sides_confidence.value_or(0), 0.95) << i;
  }
}

TEST(Smoother, LooksNoFartherAheadThanAsked) {
  const auto steps = smoothed(noticed_late(), {.sides = 10 * kFrame, .bodies = Duration{0}});
  EXPECT_GT(off(steps[5], 0.05), 0.1) << "more than ten instants before";
  EXPECT_LT(off(steps[19], 0.19), 0.05);
}

TEST(Smoother, AnswersEveryInstantOnceAndInOrderAfterTheDelay) {
  const PipelineConfig config = waiting({.sides = 5 * kFrame, .bodies = 3 * kFrame});
  Smoother smoother;
  std::uint64_t next = 0;
  for (int i = 0; i < 50; ++i) {
    const auto steps = smoother.take(seen_at(i, 0.01 * i), config);
    ASSERT_EQ(steps.size(), i < 8 ? 0u : 1u) << i;
    for (const Step& step : steps) {
      EXPECT_EQ(step.snapshot.sequence, next++);
      EXPECT_EQ(step.snapshot.bodies.front().slot, 0u);
      EXPECT_EQ(step.people.size(), 1u);
    }
  }
  const auto rest = smoother.finish(config);
  ASSERT_EQ(rest.size(), 8u);
  for (const Step& step : rest) EXPECT_EQ(step.snapshot.sequence, next++);
}

TEST(Smoother, WithoutDelayGivesWhatFusingAtOnceGives) {
  Memory memory;
  const PipelineConfig config = waiting({.sides = Duration{0}, .bodies = Duration{0}});
  Smoother smoother;
  for (int i = 0; i < 20; ++i) {
    const Perception now = seen_at(i, 0.02 * i);
    Perceived seen{now.people, now.reports, std::move(memory)};
    Step at_once = fuse(std::move(seen), now.in, now.sensors, {});
    memory = std::move(at_once.memory);
    const auto later = smoother.take(now, config);
    ASSERT_EQ(later.size(), 1u);
    const FusedBody& one = at_once.snapshot.bodies.front();
    const FusedBody& other = later.front().snapshot.bodies.front();
    for (std::size_t j = 0; j < kJointCount; ++j)
      EXPECT_EQ(one.skeleton.joints[j].position, other.skeleton.joints[j].position);
    EXPECT_EQ(one.variance, other.variance);
  }
}

TEST(Smoother, PlacesAHiddenPersonBetweenWhereTheyWereAndWhereTheyTurnUp) {
  std::vector<Perception> seen;
  for (int i = 0; i < 60; ++i) {
    // Stands, is hidden for 0.4 s, and walks when seen again.
    seen.push_back(seen_at(i, i < 40 ? 0.0 : 0.04 * (i - 35)));
    if (i < 30 || i >= 40) continue;
    Person& person = seen.back().people.front();
    person.views.clear();
    person.carried = body_at(0, 0)[SpineMid].position;
  }
  const auto now = smoothed(seen, {.sides = Duration{0}, .bodies = Duration{0}});
  const auto later = smoothed(seen, {});
  EXPECT_GT(off(now[39], 0.16), 0.12) << "who stood is expected to stand";
  EXPECT_LT(off(later[39], 0.16), 0.06);
  EXPECT_TRUE(later[35].snapshot.bodies[0].carried_for);
  EXPECT_LT(later[38].snapshot.bodies[0].variance[index_of(WristLeft)],
            now[38].snapshot.bodies[0].variance[index_of(WristLeft)]);
}

}  // namespace
}  // namespace chorus::pipeline
