// What the places of sensors leave open is part of the stated errors, of every method.
#include "fusion-server/fusion/place_errors.h"

#include <gtest/gtest.h>

#include <array>

#include "fusion-server/fusion/joint_view.h"
#include "tests/unit/fusion/body_room.h"

namespace chorus::fusion {
namespace {

using body_room::kSensors;
using body_room::standing;
using body_room::view_of;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// The sensor's place has one error, in one direction of all six.
SensorView with_error(SensorView view, const Vector6& error) {
  view.place_covariance = error * error.transpose();
  return view;
}

const Vector6 kAside = [] {
  Vector6 error = Vector6::Zero();
  error[3] = 0.04;  // [m] along x
  return error;
}();

Person seen_by(const std::vector<int>& numbers, const Vector6& error) {
  Person person{PersonId{1}, {}};
  for (const int number : numbers)
    person.views.push_back(with_error(view_of(number, standing()), error));
  return person;
}

FusionConfig by_method(Method method) {
  FusionConfig config;
  config.method = method;
  return config;
}

TEST(PlaceErrors, ATurnedAndMovedSensorMovesAPointByWhatTheFormulaSays) {
  Vector6 error;
  error << 0.003, -0.002, 0.001, 0.01, 0.02, -0.03;
  const SensorView view = with_error(view_of(2, standing()), error);
  const Eigen::Vector3d x(0.4, 1.2, -0.7);
  const Eigen::Matrix3d turn = exp_map(error.head<3>()).toRotationMatrix();
  const Eigen::Vector3d moved = view.eye + error.tail<3>() + turn * (x - view.eye);
  const Eigen::Vector3d off = moved - x;
  EXPECT_LT((place_covariance(view, x) - off * off.transpose()).norm(), 0.02 * off.squaredNorm());
  EXPECT_GT(off.norm(), 0.03);
}

TEST(PlaceErrors, AreAddedByEveryMethodAndMoveNoJoint) {
  for (const Method method :
       {Method::Otto, Method::Mean, Method::BestView, Method::InverseVariance, Method::BestSkeleton,
        Method::OttoKalman, Method::PointsAndRays, Method::BodyFilter}) {
    const FusedBody exact =
        fuse(seen_by({1, 2, 3, 4}, Vector6::Zero()), kSensors, by_method(method));
    const FusedBody open = fuse(seen_by({1, 2, 3, 4}, kAside), kSensors, by_method(method));
    const std::size_t wrist = index_of(JointId::WristLeft);
    EXPECT_EQ(open.skeleton.joints[wrist].position, exact.skeleton.joints[wrist].position);
    const Eigen::Matrix3d more = open.skeleton.joints[wrist].covariance.matrix() -
                                 exact.skeleton.joints[wrist].covariance.matrix();
    EXPECT_GT(more(0, 0), 0.25 * 0.04 * 0.04) << name_of(method);
    EXPECT_LE(more(0, 0), 1.001 * 0.04 * 0.04) << name_of(method);
    EXPECT_LT(std::abs(more(1, 1)) + std::abs(more(2, 2)), 1e-8) << name_of(method);
    EXPECT_NEAR(open.variance[wrist] - exact.variance[wrist], more.trace() / 3.0, 1e-8);
  }
}

/// What is added to the first joint's variance, seen by these with equal shares.
double added(const Person& person) {
  FusedBody body;
  body.skeleton = standing();
  ShareTally tally;
  for (const SensorView& view : person.views) tally.add(contributor_of(view.sensor, kSensors), 1.0);
  body.shares.fill(tally.shares());
  PlaceErrors().add(body, person, kSensors);
  return body.variance[0];
}

TEST(PlaceErrors, SensorsThatErrAsTheMasterDoesLeaveWhatTheMasterErrsBy) {
  // Each sensor errs by sigma, independently; relative to the master, by sqrt(2) sigma.
  const double variance = kAside.squaredNorm() / 3.0 / 2.0;
  Person pair = seen_by({1, 2}, kAside);
  pair.views[0].place_covariance.setZero();
  EXPECT_NEAR(added(pair), variance / 2.0, 0.01 * variance);
  Person four = seen_by({1, 2, 3, 4}, kAside);
  four.views[0].place_covariance.setZero();
  EXPECT_NEAR(added(four), variance * 3.0 / 4.0, 0.01 * variance);
  EXPECT_NEAR(added(seen_by({2}, kAside)), variance * 2.0, 0.01 * variance);
}

TEST(PlaceErrors, HeightsAreEachSensorsOwn) {
  Vector6 upward = Vector6::Zero();
  upward[4] = 0.04;
  const double variance = upward.squaredNorm() / 3.0;
  EXPECT_NEAR(added(seen_by({1, 2, 3, 4}, upward)), variance / 4.0, 0.01 * variance);
}

TEST(PlaceErrors, CountByTheShareOfTheSensor) {
  Person person = seen_by({1, 2}, kAside);
  person.views[0].place_covariance.setZero();
  FusedBody body;
  body.skeleton = standing();
  ShareTally tally;
  tally.add(0b01, 90.0);
  tally.add(0b10, 10.0);
  body.shares.fill(tally.shares());
  PlaceErrors().add(body, person, kSensors);
  EXPECT_NEAR(body.variance[0], 0.1 * 0.1 * kAside.squaredNorm() / 3.0, 1e-9);
}

TEST(PlaceErrors, StayWhileNobodySeesTheJoint) {
  body_room::Room room;
  const Person open = seen_by({1, 2, 3, 4}, kAside);
  FusedBody body;
  for (int step = 0; step < body_room::kFilterSteps; ++step) body = room.at(step, open.views);
  const std::size_t wrist = index_of(JointId::WristLeft);
  const auto along_x = [&] { return body.skeleton.joints[wrist].covariance.matrix()(0, 0); };
  const double seen = along_x();
  Person hidden = open;
  for (SensorView& view : hidden.views) view.skeleton.joints[wrist] = Joint{};
  body = room.at(body_room::kFilterSteps, hidden.views);
  ASSERT_EQ(body.contributors[wrist], 0U);
  EXPECT_GT(along_x(), 0.9 * seen);
  hidden.views.clear();
  hidden.carried = Eigen::Vector3d(0, 1, 0);
  body = room.memory.fuse({hidden}, {body_room::kStart + std::chrono::seconds(4), kSensors},
                          room.config)[0];
  ASSERT_TRUE(body.carried_for);
  EXPECT_GT(along_x(), 0.9 * seen);
}

TEST(PlaceErrors, AJointWithoutACovarianceGetsNone) {
  FusedBody body;
  body.skeleton = standing();
  body.contributors.fill(0b1);
  PlaceErrors().add(body, seen_by({1}, kAside), kSensors);
  EXPECT_FALSE(body.skeleton[JointId::Head].covariance.known());
}

}  // namespace
}  // namespace chorus::fusion
