// How much each sensor counts in a fused joint, and how old the joint is, for every method.
#include <gtest/gtest.h>

#include "fusion-server/fusion/fuse.h"
#include "fusion-server/fusion/inverse_variance.h"
#include "tests/unit/fusion/cameras.h"
#include "tests/unit/fusion/views.h"

namespace chorus::fusion {
namespace {

using std::chrono::milliseconds;

const std::vector<SensorId> kShareSensors{sensor(1), sensor(2), sensor(3)};
constexpr Timestamp kShareStart = from_unix_ns(1'795'246'200'000'000'000);
constexpr std::size_t kSharedNeck = index_of(JointId::Neck);

/// A person whose neck is seen; sensor 2 errs twice as much as the others.
struct SharedNeck {
  explicit SharedNeck(Method method) {
    config.method = method;
    config.noise = {.along = 0.015, .across = 0.015};
    config.sensor_noise[sensor(2)] = {.along = 0.03, .across = 0.03};
  }

  FusedBody at(Duration after, std::vector<SensorView> views) {
    return memory.fuse({{PersonId{1}, std::move(views)}}, {kShareStart + after, kShareSensors},
                       config)[0];
  }
  FusedBody unseen_at(Duration after) {
    Person person{PersonId{1}, {}};
    person.carried = Eigen::Vector3d(0, 1, 0);
    return memory.fuse({person}, {kShareStart + after, kShareSensors}, config)[0];
  }

  FusionConfig config;
  Memory memory;
};

std::vector<SensorView> two_sights() {
  return {neck_view(1, {0, 1, 0}, 0.6), neck_view(2, {0, 1, 0}, 0.2)};
}

struct MethodShare {
  Method method;
  double first;  ///< Share of sensor 1; sensor 2 has the rest.
};

TEST(JointShares, AreTheWeightsThatTheMethodUsed) {
  const std::vector<MethodShare> expected{
      // Inverse variances: 1 / 0.015^2 to 1 / 0.03^2.
      {Method::InverseVariance, 0.8},
      {Method::PointsAndRays, 0.8},
      {Method::BodyFilter, 0.8},
      {Method::Otto, 0.75},
      {Method::OttoKalman, 0.74},  // 0.62 to 0.22, with the floor of 0.02
      {Method::Mean, 0.5},
      {Method::BestView, 1.0},
      {Method::BestSkeleton, 1.0},
      {Method::JointCounting, 1.0},
      {Method::Substitution, 1.0}};
  ASSERT_EQ(expected.size(), methods().size());
  for (const MethodShare& each : expected) {
    SharedNeck neck(each.method);
    for (int i = 0; i < 3; ++i) (void)neck.at(milliseconds(33 * i), two_sights());
    const FusedBody body = neck.at(milliseconds(99), two_sights());
    const Shares& shares = body.shares[kSharedNeck];
    ASSERT_TRUE(shares.known()) << name_of(each.method);
    EXPECT_NEAR(shares.of(0), each.first, 1e-9) << name_of(each.method);
    EXPECT_NEAR(shares.of(1), 1.0 - each.first, 1e-9) << name_of(each.method);
    EXPECT_EQ(body.age[kSharedNeck], 0.0) << name_of(each.method);
    EXPECT_FALSE(body.shares[index_of(JointId::Head)].known()) << name_of(each.method);
  }
}

TEST(JointShares, OneSensorHasAll) {
  for (const MethodRow& row : methods()) {
    SharedNeck neck(row.method);
    const FusedBody body = neck.at(milliseconds(0), {neck_view(3, {0, 1, 0}, 0.6)});
    EXPECT_EQ(body.shares[kSharedNeck].of(2), 1.0) << row.name;
  }
}

TEST(JointShares, AnOutlierHasLittle) {
  for (const Method method : {Method::InverseVariance, Method::PointsAndRays, Method::BodyFilter}) {
    SharedNeck neck(method);
    neck.config.sensor_noise.clear();
    FusedBody body;
    for (int i = 0; i < 3; ++i) {
      body = neck.at(milliseconds(33 * i),
                     {neck_view(1, {0, 1, 0}, 0.5), neck_view(2, {0.003, 1, 0}, 0.5),
                      neck_view(3, {0.6, 1, 0}, 0.5)});
    }
    EXPECT_GT(body.shares[kSharedNeck].of(0), 0.45) << name_of(method);
    EXPECT_LT(body.shares[kSharedNeck].of(2), 0.1) << name_of(method);
  }
}

TEST(JointShares, ARayHasOnlyTheAxesAcrossIt) {
  SharedNeck neck(Method::PointsAndRays);
  neck.config.noise.along = neck.config.noise.across = 0.5;
  const Eigen::Vector3d eye = camera_eye(0.0);
  const Eigen::Vector3d place(0.2, 1.4, 0.1);
  SensorView ray = neck_view(3, (place - eye).normalized(), 0.5, eye);
  ray.skeleton[JointId::Neck].measurement = Measurement::Ray;
  const FusedBody body = neck.at(milliseconds(0), {neck_view(1, place, 0.5), ray});
  // The ray is 20 times as precise on two axes, and says nothing about the third.
  EXPECT_NEAR(body.shares[kSharedNeck].of(2), 2.0 / 3.0, 0.011);
  EXPECT_NEAR(body.shares[kSharedNeck].of(0), 1.0 / 3.0, 0.011);
}

TEST(JointShares, WhatMemoryAddsIsNoSensors) {
  SharedNeck neck(Method::PointsAndRays);
  const Eigen::Vector3d eye = camera_eye(0.0);
  const Eigen::Vector3d place(0.2, 1.4, 0.1);
  for (int i = 0; i < 5; ++i)
    (void)neck.at(milliseconds(33 * i), {neck_view(1, place, 0.5), neck_view(2, place, 0.5)});
  SensorView ray = neck_view(3, (place - eye).normalized(), 0.5, eye);
  ray.skeleton[JointId::Neck].measurement = Measurement::Ray;
  const FusedBody body = neck.at(milliseconds(165), {ray});  // only memory knows its depth
  EXPECT_EQ(body.contributors[kSharedNeck], 0b100U);
  EXPECT_EQ(body.shares[kSharedNeck].of(2), 1.0);
  EXPECT_EQ(body.age[kSharedNeck], 0.0);
}

TEST(JointAge, GrowsWhileAJointIsPredicted) {
  for (const Method method : {Method::OttoKalman, Method::BodyFilter}) {
    SharedNeck neck(method);
    for (int i = 0; i < 10; ++i) (void)neck.at(milliseconds(33 * i), two_sights());
    SensorView blind = neck_view(1, {0, 1, 0}, 0.5);
    blind.skeleton[JointId::Neck] = {};
    for (const int after : {33, 66, 99}) {
      const FusedBody body = neck.at(milliseconds(33 * 9 + after), {blind});
      ASSERT_TRUE(body.skeleton[JointId::Neck].seen()) << name_of(method);
      EXPECT_NEAR(body.age[kSharedNeck], 1e-3 * after, 1e-9) << name_of(method);
      EXPECT_FALSE(body.shares[kSharedNeck].known()) << name_of(method);
    }
    EXPECT_EQ(neck.at(milliseconds(33 * 13), two_sights()).age[kSharedNeck], 0.0);
  }
}

TEST(JointAge, GrowsWhileAPersonIsCarried) {
  for (const Method method : {Method::Mean, Method::BodyFilter}) {
    SharedNeck neck(method);
    (void)neck.at(milliseconds(0), two_sights());
    for (const int after : {300, 900, 2500}) {
      const FusedBody body = neck.unseen_at(milliseconds(after));
      ASSERT_TRUE(body.skeleton[JointId::Neck].seen()) << name_of(method);
      EXPECT_NEAR(body.age[kSharedNeck], 1e-3 * after, 1e-9) << name_of(method);
      EXPECT_FALSE(body.shares[kSharedNeck].known()) << name_of(method);
    }
  }
}

}  // namespace
}  // namespace chorus::fusion
