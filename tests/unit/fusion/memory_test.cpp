// Methods with memory: best skeleton with hysteresis, Otto's weights in a Kalman filter.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "common/base/units.h"
#include "fusion-server/fusion/error_model.h"
#include "fusion-server/fusion/fuse.h"
#include "tests/unit/fusion/views.h"

namespace chorus::fusion {
namespace {

using std::chrono::milliseconds;

const std::vector<SensorId> kMemorySensors{sensor(1), sensor(2)};
constexpr Timestamp kMemoryStart = from_unix_ns(1'795'246'200'000'000'000);

/// Fuses one person instant by instant and keeps the memory.
class Seen {
 public:
  explicit Seen(Method method) { config_.method = method; }

  FusedBody at(Duration after, std::vector<SensorView> views) {
    return memory_.fuse({{PersonId{1}, std::move(views)}}, {kMemoryStart + after, kMemorySensors},
                        config_)[0];
  }
  double neck_x(Duration after, std::vector<SensorView> views) {
    return at(after, std::move(views)).skeleton[JointId::Neck].position.x();
  }

  FusionConfig config_;
  Memory memory_;
};

/// The neck at x, in a view whose body is turned away from its sensor by `facing` [rad].
SensorView facing_view(int number, double x, double facing) {
  SensorView view = neck_view(number, {x, 1, 0}, 0.5);
  view.facing = facing;
  return view;
}

std::vector<SensorView> better(int number) {
  return {facing_view(1, 0.0, number == 1 ? 0.0 : deg(80)),
          facing_view(2, 1.0, number == 2 ? 0.0 : deg(80))};
}

TEST(BestSkeleton, ChangesHandsOnlyAfterTheHysteresis) {
  Seen seen(Method::BestSkeleton);
  EXPECT_EQ(seen.neck_x(milliseconds(0), better(1)), 0.0);
  EXPECT_EQ(seen.neck_x(milliseconds(33), better(2)), 0.0);
  EXPECT_EQ(seen.neck_x(milliseconds(300), better(2)), 0.0);
  EXPECT_EQ(seen.neck_x(milliseconds(340), better(2)), 1.0);
}

TEST(BestSkeleton, ARivalThatFallsBackBeginsAnew) {
  Seen seen(Method::BestSkeleton);
  EXPECT_EQ(seen.neck_x(milliseconds(0), better(1)), 0.0);
  EXPECT_EQ(seen.neck_x(milliseconds(33), better(2)), 0.0);
  EXPECT_EQ(seen.neck_x(milliseconds(200), better(1)), 0.0);
  EXPECT_EQ(seen.neck_x(milliseconds(400), better(2)), 0.0);
}

TEST(BestSkeleton, AViewThatIsGoneIsReplacedAtOnce) {
  Seen seen(Method::BestSkeleton);
  EXPECT_EQ(seen.neck_x(milliseconds(0), better(1)), 0.0);
  EXPECT_EQ(seen.neck_x(milliseconds(33), {better(1)[1]}), 1.0);
}

TEST(OttoKalman, FollowsSteadyMotionAndPredictsThroughLoss) {
  Seen seen(Method::OttoKalman);
  for (int i = 0; i <= 30; ++i) {
    seen.neck_x(milliseconds(33 * i), {neck_view(1, {0.033 * i, 1, 0}, 0.5)});
  }
  SensorView blind = neck_view(1, {0, 1, 0}, 0.5);
  blind.skeleton[JointId::Neck].state = JointState::NotTracked;
  const FusedBody lost = seen.at(milliseconds(33 * 32), {blind});
  EXPECT_NEAR(lost.skeleton[JointId::Neck].position.x(), 0.033 * 32, 0.01);
  EXPECT_EQ(lost.skeleton[JointId::Neck].state, JointState::Inferred);
  EXPECT_EQ(lost.contributors[index_of(JointId::Neck)], 0U);
  const FusedBody before = seen.at(milliseconds(33 * 33), {neck_view(1, {0.033 * 33, 1, 0}, 0.5)});
  EXPECT_GT(lost.variance[index_of(JointId::Neck)], before.variance[index_of(JointId::Neck)]);
  EXPECT_EQ(seen.at(milliseconds(33 * 33 + 400), {blind}).skeleton[JointId::Neck].state,
            JointState::NotTracked);
}

TEST(OttoKalman, AHeavyViewPullsMoreThanALightOne) {
  Seen seen(Method::OttoKalman);
  const double x =
      seen.neck_x(milliseconds(0), {neck_view(1, {0, 1, 0}, 0.98), neck_view(2, {1, 1, 0}, 0.23)});
  EXPECT_NEAR(x, 0.2, 1e-6);  // the views' variances are R0 / 1.00 and R0 / 0.25
}

TEST(FusionMemory, CopiesGoOnApart) {
  Seen seen(Method::BestSkeleton);
  EXPECT_EQ(seen.neck_x(milliseconds(0), better(1)), 0.0);
  Seen copy = seen;
  EXPECT_EQ(copy.neck_x(milliseconds(33), {better(2)[1]}), 1.0);
  EXPECT_EQ(seen.neck_x(milliseconds(66), better(2)), 0.0) << "it has not seen what the copy saw";
}

TEST(FusionMemory, ACopyRemembersWhatTheOriginalSaw) {
  Seen seen(Method::BestSkeleton);
  EXPECT_EQ(seen.neck_x(milliseconds(0), better(1)), 0.0);
  Seen copy = seen;
  EXPECT_EQ(copy.neck_x(milliseconds(33), better(2)), 0.0) << "sensor 1 had been the best";
}

TEST(FusionMemory, PeopleWhoLeftAndAnotherConfigurationBeginAnew) {
  Seen seen(Method::BestSkeleton);
  EXPECT_EQ(seen.neck_x(milliseconds(0), better(1)), 0.0);
  seen.memory_.keep_only({PersonId{1}});
  EXPECT_EQ(seen.neck_x(milliseconds(33), better(2)), 0.0);
  seen.memory_.keep_only({PersonId{2}});
  EXPECT_EQ(seen.neck_x(milliseconds(66), better(2)), 1.0);
  seen.config_.huber = 2.0;
  EXPECT_EQ(seen.neck_x(milliseconds(99), better(1)), 0.0);
}

TEST(FusionMemory, ABodyIsAsSureOfItsSidesAsThePerson) {
  Memory memory;
  Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.5)}};
  EXPECT_FALSE(memory.fuse({person}, {kMemoryStart, kMemorySensors}, {})[0].sides_confidence);
  person.sides_confidence = 0.75;
  EXPECT_EQ(memory.fuse({person}, {kMemoryStart, kMemorySensors}, {})[0].sides_confidence, 0.75);
}

/// Somebody whom no sensor sees, expected at x.
Person expected_at(double x) {
  Person person{PersonId{1}, {}};
  person.carried = Eigen::Vector3d(x, 1, 0);
  return person;
}

TEST(FusionMemory, CarriesSomebodyWhomNobodySees) {
  Seen seen(Method::Mean);
  const FusedBody last = seen.at(milliseconds(0), {neck_view(1, {0, 1, 0}, 0.5)});
  EXPECT_FALSE(last.carried_for);
  const auto after = [&](Duration time) {
    return seen.memory_.fuse({expected_at(0.3)}, {kMemoryStart + time, kMemorySensors},
                             seen.config_)[0];
  };
  const FusedBody body = after(milliseconds(300));
  EXPECT_NEAR(body.carried_for.value(), 0.3, 1e-9);
  EXPECT_NEAR(body.skeleton[JointId::Neck].position.x(), 0.3, 1e-12);
  EXPECT_EQ(body.skeleton[JointId::Neck].state, JointState::Inferred);
  EXPECT_EQ(body.contributors[index_of(JointId::Neck)], 0u);
  EXPECT_GT(body.variance[index_of(JointId::Neck)], last.variance[index_of(JointId::Neck)]);
  EXPECT_GT(after(milliseconds(900)).variance[index_of(JointId::Neck)],
            body.variance[index_of(JointId::Neck)]);
}

TEST(FusionMemory, ABodyWithoutJointsIsNotWhatIsCarried) {
  Seen seen(Method::Mean);
  (void)seen.at(milliseconds(0), {neck_view(1, {0, 1, 0}, 0.5)});
  SensorView nothing = neck_view(1, {0, 1, 0}, 0.5);
  for (Joint& joint : nothing.skeleton.joints) joint = {};
  (void)seen.at(milliseconds(200), {nothing});
  const FusedBody body = seen.memory_.fuse(
      {expected_at(0.3)}, {kMemoryStart + milliseconds(300), kMemorySensors}, seen.config_)[0];
  EXPECT_TRUE(body.skeleton[JointId::Neck].seen());
  EXPECT_NEAR(body.carried_for.value(), 0.3, 1e-9) << "since there was a place";
}

TEST(FusionMemory, LeavesItToAMethodThatPredicts) {
  Seen seen(Method::OttoKalman);
  for (int i = 0; i < 30; ++i)
    (void)seen.at(milliseconds(33 * i), {neck_view(1, {0.033 * i, 1, 0}, 0.5)});
  const auto bodies = seen.memory_.fuse(
      {expected_at(5.0)}, {kMemoryStart + milliseconds(33 * 32), kMemorySensors}, seen.config_);
  EXPECT_TRUE(bodies[0].carried_for);
  EXPECT_NEAR(bodies[0].skeleton[JointId::Neck].position.x(), 1.05, 0.05);
}

TEST(ErrorModel, BelievesAMeasurementThatBringsItsCovariance) {
  SensorView view = neck_view(1, {0, 1, 0}, 0.5, {0, 1, 5});
  const auto errors = line_of_sight_errors({.along = 0.1, .across = 0.01}, {});
  EXPECT_NEAR(errors->covariance(view, JointId::Neck)(2, 2), 0.01, 1e-12);
  EXPECT_NEAR(errors->covariance(view, JointId::Neck)(0, 0), 0.0001, 1e-12);
  view.skeleton[JointId::Neck].covariance =
      Covariance(Eigen::Vector3d(4e-4, 5e-4, 6e-4).asDiagonal().toDenseMatrix());
  EXPECT_NEAR(errors->covariance(view, JointId::Neck)(2, 2), 6e-4, 1e-7);
}

TEST(ErrorModel, BelievesNobodyToBeBetterThanABodyCanBeKnown) {
  SensorView view = neck_view(1, {0, 1, 0}, 0.5, {0, 1, 5});
  view.skeleton[JointId::Neck].covariance =
      Covariance(Eigen::Vector3d(1e-12, 4e-4, 0).asDiagonal().toDenseMatrix());
  const auto errors = line_of_sight_errors({}, {});
  EXPECT_NEAR(errors->covariance(view, JointId::Neck)(0, 0), 9e-6, 1e-7);
  EXPECT_NEAR(errors->covariance(view, JointId::Neck)(2, 2), 9e-6, 1e-7);
  view.skeleton[JointId::Neck].measurement = Measurement::Ray;
  EXPECT_NEAR(errors->covariance(view, JointId::Neck)(0, 0), 1e-6, 1e-7);
}

TEST(ErrorModel, ASensorMayHaveANoiseOfItsOwn) {
  const SensorView view = neck_view(2, {0, 1, 0}, 0.5, {0, 1, 5});
  const auto errors = line_of_sight_errors({}, {{sensor(2), {.along = 0.2, .across = 0.1}}});
  EXPECT_NEAR(errors->covariance(view, JointId::Neck)(2, 2), 0.04, 1e-12);
}

TEST(Rays, AreRefusedByMethodsThatNeedPlaces) {
  for (const MethodRow& row : methods()) {
    if (row.method == Method::PointsAndRays || row.method == Method::BodyFilter) continue;
    Seen seen(row.method);
    SensorView ray = neck_view(1, {0, 0, 1}, 0.5);
    ray.skeleton[JointId::Neck].measurement = Measurement::Ray;
    const FusedBody body = seen.at(milliseconds(0), {ray, neck_view(2, {1, 1, 0}, 0.5)});
    EXPECT_EQ(body.contributors[index_of(JointId::Neck)] & 1U, 0U) << row.name;
  }
}

TEST(FusedJoint, StatesACovarianceWhoseMeanIsItsVariance) {
  for (const MethodRow& row : methods()) {
    Seen seen(row.method);
    const FusedBody body = seen.at(milliseconds(0), {neck_view(1, {0, 1, 0}, 0.5)});
    const Covariance& covariance = body.skeleton[JointId::Neck].covariance;
    ASSERT_TRUE(covariance.known()) << row.name;
    EXPECT_NEAR(covariance.matrix().trace() / 3, body.variance[index_of(JointId::Neck)], 1e-9)
        << row.name;
  }
}

}  // namespace
}  // namespace chorus::fusion
