#include "fusion-server/pipeline/pipeline.h"

#include <chrono>
#include <ctime>

#include <gtest/gtest.h>

#include "fusion-server/fusion/methods.h"
#include "tests/support/builders.h"
#include "tests/unit/pipeline/ring.h"

namespace chorus::pipeline {
namespace {

using std::chrono::milliseconds;

/// Settings with a method without memory, because the people of ring.h have no bones whose lengths
/// a filter could learn.
PipelineConfig without_memory() {
  PipelineConfig config;
  config.fusion.method = fusion::Method::InverseVariance;
  return config;
}

/// Steps at 30 Hz from 0.2 s on; returns the last step.
Step run(const Histories& histories, const Registration& registration, int steps,
         const PipelineConfig& config = without_memory()) {
  Step result;
  for (int i = 0; i < steps; ++i) {
    const Timestamp instant = kStart + milliseconds(200 + 33 * i);
    result = step({instant, instant + milliseconds(80), static_cast<std::uint64_t>(i)}, histories,
                  registration, result.memory, config);
  }
  return result;
}

double worst_error(const FusedBody& body, const Skeleton<WorldSpace>& truth) {
  double worst = 0;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const double off = (body.skeleton.joints[i].position - truth.joints[i].position).norm();
    worst = std::max(worst, off);
  }
  return worst;
}

TEST(Step, PerfectViewsOfOneWalkerGiveTheWalkerBack) {
  const Step last = run(ring_histories({}), ring_registration(6), 20);
  ASSERT_EQ(last.snapshot.bodies.size(), 1u);
  const double t = seconds(last.snapshot.instant - kStart);
  // Linear interpolation on a circle of 0.8 m at 0.7 rad/s is off by the sagitta: 0.4 m/s^2 (1/30
  // s)^2 / 8 = 0.05 mm.
  EXPECT_LT(worst_error(last.snapshot.bodies[0], walker(0, t)), mm(0.1));
  EXPECT_EQ(last.snapshot.bodies[0].contributors[0], 0b111111u);
  EXPECT_EQ(last.snapshot.sensors.size(), 6u);
}

TEST(Step, EveryMethodAnswersForThePersonInTheMiddle) {
  for (const auto method : {fusion::Method::Otto, fusion::Method::Mean, fusion::Method::BestView,
                            fusion::Method::InverseVariance}) {
    PipelineConfig config;
    config.fusion.method = method;
    const Step last = run(ring_histories({}), ring_registration(6), 10, config);
    ASSERT_EQ(last.snapshot.bodies.size(), 1u) << fusion::name_of(method);
    const double t = seconds(last.snapshot.instant - kStart);
    EXPECT_LT(worst_error(last.snapshot.bodies[0], walker(0, t)), mm(0.1));
  }
}

TEST(Step, SaysWhichVersionOfTheRegistrationPlacedTheSensors) {
  Registration registration = ring_registration(6);
  registration.version = 7;
  EXPECT_EQ(run(ring_histories({}), registration, 2).snapshot.registration_version, 7u);
}

TEST(Perceive, HandsOnTheViewsThatStepFuses) {
  const Histories histories = ring_histories({.people = 2});
  const Registration registration = ring_registration(6);
  const Step last = run(histories, registration, 10);
  const Timestamp next = last.snapshot.instant + milliseconds(33);
  const Inputs in{next, next + milliseconds(80), 10};
  const Perceived perceived = perceive(in, histories, registration, last.memory, without_memory());
  const Step fused = step(in, histories, registration, last.memory, without_memory());
  ASSERT_EQ(perceived.people.size(), 2u);
  ASSERT_EQ(fused.snapshot.bodies.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(perceived.people[i].views.size(), 6u);
    const FusedBody again =
        fusion::fuse(perceived.people[i], fused.snapshot.sensors, without_memory().fusion);
    EXPECT_EQ(again.id, fused.snapshot.bodies[i].id);
    EXPECT_EQ(again.skeleton[JointId::Neck].position,
              fused.snapshot.bodies[i].skeleton[JointId::Neck].position);
  }
  EXPECT_EQ(perceived.memory.tracks.people.size(), fused.memory.tracks.people.size());
}

TEST(Step, WhatTheRegistrationLeavesOpenIsInTheStatedErrors) {
  Registration loose = ring_registration(6);
  for (auto& [sensor, place] : loose.sensors) place.covariance(5, 5) = mm(40) * mm(40);
  for (const PipelineConfig& config : {without_memory(), PipelineConfig{}}) {
    const Step exact = run(ring_histories({}), ring_registration(6), 20, config);
    const Step open = run(ring_histories({}), loose, 20, config);
    ASSERT_EQ(open.snapshot.bodies.size(), 1u);
    const auto along_z = [](const Step& step) {
      return step.snapshot.bodies[0].skeleton[JointId::Neck].covariance.matrix()(2, 2);
    };
    EXPECT_GT(along_z(open) - along_z(exact), 0.15 * mm(40) * mm(40));
  }
}

TEST(Step, ThreePeopleSeenByTenSensorsAreThreePeople) {
  const Step last = run(ring_histories({.sensors = 10, .people = 3}), ring_registration(10), 20);
  EXPECT_EQ(last.snapshot.bodies.size(), 3u);
}

TEST(Step, SeatsItsPeopleOnceForAllOutputs) {
  const Step last = run(ring_histories({.people = 2}), ring_registration(6), 20);
  ASSERT_EQ(last.snapshot.bodies.size(), 2u);
  EXPECT_EQ(last.snapshot.bodies[0].slot, 0u);
  EXPECT_EQ(last.snapshot.bodies[1].slot, 1u);
  // Nobody is seen for half a second: somebody who comes meanwhile gets neither of the two slots.
  Histories empty = ring_histories({.length = milliseconds(1)});
  for (auto& [name, history] : empty) history = align::History();
  const Timestamp later = last.snapshot.instant + milliseconds(500);
  const Step gone =
      step({later, later + milliseconds(80), 20}, empty, ring_registration(6), last.memory, {});
  std::vector<FusedBody> newcomer(1);
  newcomer[0].id = {99};
  Seating seating = gone.memory.seating;
  seating.seat(newcomer, later, std::chrono::seconds(1));
  EXPECT_EQ(newcomer[0].slot, 2u);
}

TEST(Step, KeepsASlotAsLongAsAssociationLooksOut) {
  PipelineConfig config;
  config.association.coast = milliseconds(200);
  const Step last = run(ring_histories({}), ring_registration(6), 10, config);
  const Timestamp later = last.snapshot.instant + milliseconds(300);
  const Step gone =
      step({later, later + milliseconds(80), 10}, {}, ring_registration(6), last.memory, config);
  std::vector<FusedBody> newcomer(1);
  newcomer[0].id = {99};
  Seating seating = gone.memory.seating;
  seating.seat(newcomer, later, std::chrono::seconds(1));
  EXPECT_EQ(newcomer[0].slot, 0u);
}

TEST(Step, FramesOfUnregisteredSensorsAreReportedButNotUsed) {
  Registration registration = ring_registration(6);
  registration.sensors.erase(sensor(2));
  const Step last = run(ring_histories({}), registration, 10);
  ASSERT_EQ(last.snapshot.bodies.size(), 1u);
  EXPECT_EQ(last.snapshot.sensors.size(), 5u);
  EXPECT_EQ(last.snapshot.bodies[0].contributors[0], 0b11111u);
  ASSERT_EQ(last.snapshot.reports.size(), 6u);
  EXPECT_EQ(last.snapshot.reports[2].sensor, sensor(2));
  EXPECT_EQ(last.snapshot.reports[2].bodies, 1u);
}

TEST(Weights, AreUsedByTheMethodsOfOttoAndByTheBestView) {
  for (const fusion::MethodRow& row : fusion::methods()) {
    const bool wanted = row.name.starts_with("otto") || row.name == "best-view";
    EXPECT_EQ(uses_weights(row.method), wanted) << row.name;
  }
}

TEST(Step, ADeadSensorChangesNothingButItsReport) {
  Histories histories = ring_histories({});
  histories[sensor(3)] = align::History();
  const Step last = run(histories, ring_registration(6), 10);
  ASSERT_EQ(last.snapshot.bodies.size(), 1u);
  EXPECT_EQ(last.snapshot.reports[3].basis, Basis::Pending);
  const double t = seconds(last.snapshot.instant - kStart);
  EXPECT_LT(worst_error(last.snapshot.bodies[0], walker(0, t)), mm(0.1));
}

TEST(Step, WithoutARegistrationThereIsNobodyButReports) {
  const Step last = run(ring_histories({}), Registration{}, 5);
  EXPECT_TRUE(last.snapshot.bodies.empty());
  EXPECT_EQ(last.snapshot.reports.size(), 6u);
}

TEST(Step, TwoBodiesWithOneIdInAFrameAreOnePerson) {
  Histories histories;
  for (auto [id, history] : ring_histories({})) {
    for (SensorFrame frame : history.frames()) {
      frame.bodies.push_back(frame.bodies[0]);
      histories[id].push(std::move(frame));
    }
  }
  EXPECT_EQ(run(histories, ring_registration(6), 10).snapshot.bodies.size(), 1u);
}

TEST(StepProperty, MovingAllSensorsByOneTransformMovesTheResult) {
  Eigen::Isometry3d moved_from_world = Eigen::Isometry3d::Identity();
  moved_from_world.linear() = about_y(deg(70)).toRotationMatrix();
  moved_from_world.translation() = Eigen::Vector3d(3, 0.5, -4);
  Registration moved = ring_registration(6);
  for (auto& [id, place] : moved.sensors) {
    place.world_from_sensor = moved_from_world * place.world_from_sensor;
  }
  const Histories histories = ring_histories({});
  const FusedBody before = run(histories, ring_registration(6), 10).snapshot.bodies.at(0);
  const FusedBody after = run(histories, moved, 10).snapshot.bodies.at(0);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Eigen::Vector3d expected = moved_from_world * before.skeleton.joints[i].position;
    EXPECT_LT((expected - after.skeleton.joints[i].position).norm(), 1e-9);
  }
}

/// Four sensors that see two people, one of them larger; `exchanged`: under each other's ids.
void push_two(Histories& histories, Timestamp instant, bool exchanged) {
  for (int i = 0; i < 4; ++i) {
    SensorFrame frame;
    frame.sensor = sensor(i);
    frame.captured = instant;
    for (const int k : {0, 1}) {
      Skeleton<WorldSpace> body = testing::standing_person();
      for (Joint& joint : body.joints) {
        joint.position *= (k == 0) == exchanged ? 1.1 : 1.0;
        joint.position.x() += 1.2 * k - 0.6;
      }
      frame.bodies.push_back({BodyId{static_cast<std::uint64_t>(k)}, instant,
                              to_sensor(ring_place(i, 4).inverse(), body)});
    }
    histories[sensor(i)].push(std::move(frame));
  }
}

TEST(Step, WhoGetsAnotherIdIsNotFusedByWhatTheOtherTaught) {
  constexpr int kExchange = 180;
  const PipelineConfig config;
  Histories histories;
  Step last;
  for (int i = 0; i < 300 && last.snapshot.corrections.empty(); ++i) {
    const Timestamp instant = kStart + i * milliseconds(33);
    push_two(histories, instant, i >= kExchange);
    last = step({instant, instant, static_cast<std::uint64_t>(i)}, histories, ring_registration(4),
                last.memory, config);
    ASSERT_TRUE(i > kExchange || last.snapshot.corrections.empty()) << i;
  }
  ASSERT_EQ(last.snapshot.corrections.size(), 2u);
  ASSERT_EQ(last.people.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const FusedBody alone = fusion::fuse(last.people[i], last.snapshot.sensors, config.fusion);
    EXPECT_EQ(last.snapshot.bodies[i].id, alone.id);
    EXPECT_EQ(last.snapshot.bodies[i].variance, alone.variance) << "nothing is remembered";
    EXPECT_EQ(last.memory.sides.people.at(alone.id).seen, last.snapshot.instant);
  }
}

TEST(Awaited, AreRegisteredSensorsOnlyAndOnlySoLong) {
  Histories histories = ring_histories({});
  const Registration registration = ring_registration(6);
  const auto at = [&](Timestamp instant, Timestamp now) {
    auto awaited = all_awaited(histories, registration, {});
    drop_settled(awaited.sensors, {instant, now, 0}, histories);
    return awaited.sensors.size();
  };
  const Timestamp inside = kStart + milliseconds(500);
  EXPECT_EQ(at(inside, inside), 0u);
  const Timestamp beyond = kStart + milliseconds(2010);
  EXPECT_EQ(at(beyond, beyond), 6u);
  EXPECT_EQ(at(beyond, beyond + milliseconds(201)), 0u);
  histories[sensor(77)] = align::History();
  EXPECT_EQ(at(inside, inside), 0u);
}

TEST(StepCost, TenSensorsAndSixPeopleFitManyTimesIntoAFrame) {
  const Histories histories = ring_histories({.sensors = 10, .people = 6});
  const Registration registration = ring_registration(10);
  const std::clock_t start = std::clock();  // Processor time, whatever else the machine does.
  constexpr int kSteps = 20;
  const Step last = run(histories, registration, kSteps);
  const double spent = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  RecordProperty("step_microseconds", static_cast<int>(1e6 * spent / kSteps));
  EXPECT_FALSE(last.snapshot.bodies.empty());
  EXPECT_LT(spent / kSteps, 0.1);  // Generous: also under sanitizers.
}

}  // namespace
}  // namespace chorus::pipeline
