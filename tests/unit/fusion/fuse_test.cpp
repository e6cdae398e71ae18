#include "fusion-server/fusion/fuse.h"

#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/unit/fusion/views.h"

namespace chorus::fusion {
namespace {

constexpr double kFuseNan = std::numeric_limits<double>::quiet_NaN();
const std::vector<SensorId> kFuseSensors{sensor(1), sensor(2), sensor(3), sensor(4)};
constexpr std::array kMethods{
    Method::Otto,         Method::Mean,       Method::BestView,      Method::InverseVariance,
    Method::BestSkeleton, Method::OttoKalman, Method::PointsAndRays, Method::BodyFilter};

FusionConfig by(Method method) {
  FusionConfig config;
  config.method = method;
  return config;
}

Joint fused_neck(const Person& person, const FusionConfig& config) {
  return fuse(person, kFuseSensors, config).skeleton[JointId::Neck];
}

TEST(OttoFusion, IsTheWeightedMean) {
  const Person person{PersonId{1},
                      {neck_view(1, {0, 1, 0}, 0.75), neck_view(2, {0.4, 1, 0}, 0.25)}};
  const FusedBody body = fuse(person, kFuseSensors, by(Method::Otto));
  EXPECT_EQ(body.id, PersonId{1});
  EXPECT_NEAR(body.skeleton[JointId::Neck].position.x(), 0.1, 1e-12);
  EXPECT_EQ(body.contributors[index_of(JointId::Neck)], 0b11u);
}

TEST(OttoFusion, AViewOfWeightZeroIsIgnored) {
  const Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.01), neck_view(3, {9, 9, 9}, 0)}};
  const FusedBody body = fuse(person, kFuseSensors, by(Method::Otto));
  EXPECT_EQ(body.skeleton[JointId::Neck].position, Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(body.contributors[index_of(JointId::Neck)], 0b001u);
}

TEST(OttoFusion, WhenAllWeightsAreZeroEveryViewCountsTheSame) {
  const Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0), neck_view(2, {0.4, 1, 0}, 0)}};
  EXPECT_NEAR(fused_neck(person, by(Method::Otto)).position.x(), 0.2, 1e-12);
  FusionConfig strict = by(Method::Otto);
  strict.zero_weight_floor = 0;
  EXPECT_EQ(fused_neck(person, strict).state, JointState::NotTracked);
}

TEST(OttoFusion, AJointSeenOnlyByZeroWeightViewsIsStillAnswered) {
  Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.5), neck_view(2, {0.4, 1, 0}, 0)}};
  person.views[0].skeleton[JointId::Neck].state = JointState::NotTracked;
  EXPECT_NEAR(fused_neck(person, by(Method::Otto)).position.x(), 0.4, 1e-12);
}

TEST(OttoFusion, AWeightThatIsNotANumberIsZero) {
  const Person person{PersonId{1},
                      {neck_view(1, {0, 1, 0}, 0.5), neck_view(2, {9, 9, 9}, kFuseNan)}};
  EXPECT_EQ(fused_neck(person, by(Method::Otto)).position, Eigen::Vector3d(0, 1, 0));
}

TEST(OttoFusion, OrientationsAreSignAlignedBeforeTheLerp) {
  Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.5), neck_view(2, {0, 1, 0}, 0.5)}};
  person.views[0].skeleton[JointId::Neck].orientation = about_y(deg(10));
  person.views[1].skeleton[JointId::Neck].orientation.coeffs() = -about_y(deg(30)).coeffs();
  EXPECT_NEAR(angular_distance(fused_neck(person, by(Method::Otto)).orientation, about_y(deg(20))),
              0, 1e-9);
}

TEST(BestViewFusion, TakesTheHeaviestAloneAndBreaksTiesBySeenJoints) {
  Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.2), neck_view(2, {0.4, 1, 0}, 0.3)}};
  EXPECT_DOUBLE_EQ(fused_neck(person, by(Method::BestView)).position.x(), 0.4);
  person.views[0].weight = 0.3;
  person.views[0].skeleton[JointId::Head] = person.views[0].skeleton[JointId::Neck];
  EXPECT_DOUBLE_EQ(fused_neck(person, by(Method::BestView)).position.x(), 0.0);
}

TEST(Fuse, AJointNobodySawIsNotTracked) {
  for (const Method method : kMethods) {
    const Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.5)}};
    const FusedBody body = fuse(person, kFuseSensors, by(method));
    const Joint& head = body.skeleton[JointId::Head];
    EXPECT_EQ(head.state, JointState::NotTracked) << name_of(method);
    EXPECT_EQ(head.position, Eigen::Vector3d::Zero());
    EXPECT_EQ(body.contributors[index_of(JointId::Head)], 0u);
    EXPECT_EQ(body.variance[index_of(JointId::Head)], 0.0);
  }
}

TEST(Fuse, APersonWithoutViewsIsEmptyNotACrash) {
  for (const Method method : kMethods) {
    EXPECT_EQ(fused_neck(Person{PersonId{3}, {}}, by(method)).state, JointState::NotTracked);
  }
}

TEST(Fuse, CoordinatesThatAreNotNumbersNeverReachTheResult) {
  Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.5), neck_view(2, {kFuseNan, 1, 0}, 0.5)}};
  person.views[0].eye = {kFuseNan, kFuseNan, kFuseNan};
  for (const Method method : {Method::Otto, Method::Mean, Method::InverseVariance}) {
    EXPECT_TRUE(fused_neck(person, by(method)).position.isApprox(Eigen::Vector3d(0, 1, 0)))
        << name_of(method);
  }
}

TEST(Fuse, TrackedIfAnyContributorIsElseInferred) {
  Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.5), neck_view(2, {0, 1, 0}, 0.5)}};
  person.views[0].skeleton[JointId::Neck].state = JointState::Inferred;
  for (const Method method : {Method::Otto, Method::Mean, Method::InverseVariance}) {
    EXPECT_EQ(fused_neck(person, by(method)).state, JointState::Tracked);
  }
  person.views[1].skeleton[JointId::Neck].state = JointState::Inferred;
  for (const Method method : kMethods) {
    EXPECT_EQ(fused_neck(person, by(method)).state, JointState::Inferred) << name_of(method);
  }
}

TEST(Fuse, OrientationNobodyGaveStaysAllZero) {
  Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.5)}};
  person.views[0].skeleton[JointId::Neck].orientation = Eigen::Quaterniond(0, 0, 0, 0);
  for (const Method method : kMethods) {
    EXPECT_EQ(fused_neck(person, by(method)).orientation.coeffs().norm(), 0.0);
  }
}

TEST(Fuse, ASensorBeyondTheListContributesWithoutABit) {
  const Person person{PersonId{1}, {neck_view(9, {0, 1, 0}, 0.5)}};
  const FusedBody body = fuse(person, kFuseSensors, by(Method::Mean));
  EXPECT_EQ(body.skeleton[JointId::Neck].state, JointState::Tracked);
  EXPECT_EQ(body.contributors[index_of(JointId::Neck)], 0u);
}

TEST(Fuse, MoreViewsMeanLessVarianceAndTheCommonPartStays) {
  FusionConfig config = by(Method::InverseVariance);
  config.common_sigma = 0.015;
  Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.5)}};
  const double one = fuse(person, kFuseSensors, config).variance[index_of(JointId::Neck)];
  person.views.push_back(neck_view(2, {0, 1, 0}, 0.5, {5, 1, 0}));
  const double two = fuse(person, kFuseSensors, config).variance[index_of(JointId::Neck)];
  EXPECT_LT(two, one);
  EXPECT_GT(two, 0.015 * 0.015);
}

TEST(Fuse, StatesMoreErrorFartherOutAndForGuesses) {
  Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.5)}};
  Skeleton<WorldSpace>& body = person.views[0].skeleton;
  for (const JointId id : {JointId::Head, JointId::HipLeft, JointId::KneeLeft, JointId::WristLeft,
                           JointId::HandTipLeft})
    body[id] = body[JointId::Neck];
  const auto variance = [&](JointId id) {
    return fuse(person, kFuseSensors, by(Method::InverseVariance)).variance[index_of(id)];
  };
  EXPECT_LT(variance(JointId::Neck), variance(JointId::Head));
  EXPECT_LT(variance(JointId::Head), variance(JointId::HipLeft));
  EXPECT_LT(variance(JointId::HipLeft), variance(JointId::KneeLeft));
  EXPECT_LT(variance(JointId::KneeLeft), variance(JointId::WristLeft));
  EXPECT_LT(variance(JointId::WristLeft), variance(JointId::HandTipLeft));
  const double tracked = variance(JointId::HandTipLeft);
  body[JointId::HandTipLeft].state = JointState::Inferred;
  EXPECT_GT(variance(JointId::HandTipLeft), 1.5 * tracked);
}

TEST(Fuse, BelievesACovarianceThatAMeasurementBrings) {
  Person person{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.5)}};
  Joint& tip = person.views[0].skeleton[JointId::HandTipLeft];
  tip = person.views[0].skeleton[JointId::Neck];
  tip.covariance = Covariance(Eigen::Matrix3d(1e-4 * Eigen::Matrix3d::Identity()));
  const double variance = fuse(person, kFuseSensors, by(Method::InverseVariance))
                              .variance[index_of(JointId::HandTipLeft)];
  EXPECT_NEAR(variance, 1e-4 + 0.004 * 0.004, 1e-6);
}

Person random_person(std::mt19937& random, int views) {
  std::normal_distribution<double> noise(0.0, 0.05);
  std::uniform_real_distribution<double> weight(0.0, 1.0);
  Person person{PersonId{1}, {}};
  for (int i = 1; i <= views; ++i) {
    SensorView view = neck_view(i, {0, 1, 0}, weight(random), {3.0 * i, 1, 5.0 - i});
    for (Joint& joint : view.skeleton.joints) {
      joint.position = Eigen::Vector3d(noise(random), 1 + noise(random), noise(random));
      joint.orientation = exp_map(Eigen::Vector3d(noise(random), noise(random), noise(random)));
      joint.state = weight(random) < 0.2 ? JointState::Inferred : JointState::Tracked;
    }
    person.views.push_back(view);
  }
  return person;
}

TEST(FuseProperty, TheOrderOfViewsDoesNotMatter) {
  std::mt19937 random(1);
  for (int round = 0; round < 50; ++round) {
    Person person = random_person(random, 4);
    for (const Method method : kMethods) {
      const FusedBody before = fuse(person, kFuseSensors, by(method));
      std::shuffle(person.views.begin(), person.views.end(), random);
      const FusedBody after = fuse(person, kFuseSensors, by(method));
      for (std::size_t i = 0; i < kJointCount; ++i) {
        const Joint& a = before.skeleton.joints[i];
        const Joint& b = after.skeleton.joints[i];
        EXPECT_LT((a.position - b.position).norm(), 1e-9);
        EXPECT_LT(angular_distance(a.orientation, b.orientation), 1e-6);
        EXPECT_EQ(a.state, b.state);
        EXPECT_EQ(before.contributors[i], after.contributors[i]);
      }
    }
  }
}

void expect_same_when_moved(const Eigen::Isometry3d& moved_from_world,
                            std::initializer_list<Method> methods) {
  std::mt19937 random(2);
  for (int round = 0; round < 20; ++round) {
    const Person person = random_person(random, 3);
    Person moved = person;
    for (SensorView& view : moved.views) {
      view.eye = moved_from_world * view.eye;
      for (Joint& joint : view.skeleton.joints) joint.position = moved_from_world * joint.position;
    }
    for (const Method method : methods) {
      const FusedBody before = fuse(person, kFuseSensors, by(method));
      const FusedBody after = fuse(moved, kFuseSensors, by(method));
      for (std::size_t i = 0; i < kJointCount; ++i) {
        const Eigen::Vector3d expected = moved_from_world * before.skeleton.joints[i].position;
        EXPECT_LT((expected - after.skeleton.joints[i].position).norm(), 1e-9) << name_of(method);
      }
    }
  }
}

TEST(FuseProperty, MovingTheWorldMovesTheResult) {
  Eigen::Isometry3d tilted = Eigen::Isometry3d::Identity();
  tilted.linear() = exp_map({0.3, -1.1, 0.2}).toRotationMatrix();
  tilted.translation() = Eigen::Vector3d(4, -2, 7);
  expect_same_when_moved(tilted,
                         {Method::Otto, Method::Mean, Method::BestView, Method::InverseVariance,
                          Method::BestSkeleton, Method::OttoKalman, Method::PointsAndRays});
  Eigen::Isometry3d upright(about_y(1.1));  // the body filter depends on which way is up
  upright.translation() = Eigen::Vector3d(4, -2, 7);
  expect_same_when_moved(upright, {Method::BodyFilter});
}

TEST(MethodNames, StandInWhatAMethodFused) {
  FusionConfig config;
  config.method = Method::Mean;
  EXPECT_EQ(fuse({PersonId{1}, {}}, {}, config).method, "mean");
}

TEST(MethodNames, GoBothWays) {
  for (const Method method : kMethods) EXPECT_EQ(method_named(name_of(method)), method);
  EXPECT_FALSE(method_named("kalman").has_value());
}

}  // namespace
}  // namespace chorus::fusion
