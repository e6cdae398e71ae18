// Method::PointsAndRays, including what it remembers between instants.
#include "fusion-server/fusion/points_and_rays.h"

#include <gtest/gtest.h>

#include "common/base/square.h"
#include "fusion-server/fusion/error_model.h"
#include "fusion-server/fusion/fuse.h"
#include "fusion-server/fusion/landmark_error.h"
#include "tests/unit/fusion/cameras.h"
#include "tests/unit/fusion/views.h"

namespace chorus::fusion {
namespace {

using std::chrono::milliseconds;

const std::vector<SensorId> kRaySensors{sensor(1), sensor(2), sensor(3)};
constexpr Timestamp kRayStart = from_unix_ns(1'795'246'200'000'000'000);
constexpr std::size_t kNeck = index_of(JointId::Neck);

SensorView ray_view(int number, const Eigen::Vector3d& neck) {
  const Eigen::Vector3d eye = camera_eye(1.3 * number);
  SensorView view = neck_view(number, (neck - eye).normalized(), 0.5, eye);
  view.skeleton[JointId::Neck].measurement = Measurement::Ray;
  view.skeleton[JointId::Neck].orientation.coeffs().setZero();
  return view;
}

struct Cell {
  Cell() { config.method = Method::PointsAndRays; }

  FusedBody at(Duration after, std::vector<SensorView> views) {
    return memory.fuse({{PersonId{1}, std::move(views)}}, {kRayStart + after, kRaySensors},
                       config)[0];
  }

  FusionConfig config;
  Memory memory;
};

TEST(PointsAndRays, TwoRaysMakeAJointWithItsContributors) {
  Cell cell;
  const Eigen::Vector3d neck(0.2, 1.4, 0.1);
  const FusedBody body = cell.at(milliseconds(0), {ray_view(1, neck), ray_view(2, neck)});
  const Joint& joint = body.skeleton[JointId::Neck];
  EXPECT_LT((joint.position - neck).norm(), 1e-9);
  EXPECT_EQ(joint.state, JointState::Tracked);
  EXPECT_EQ(joint.measurement, Measurement::Point);
  EXPECT_EQ(body.contributors[kNeck], 0b11U);
  // An error of half a degree is 26 mm at about 3 m.
  EXPECT_NEAR(std::sqrt(body.variance[kNeck]), 0.026, 0.01);
}

TEST(PointsAndRays, TakesPointsOfGuessedDepthFromTheBodyFilterButNoOthers) {
  // Two sensors are needed: a single view that states all covariances is taken for a body that
  // somebody else has fused already.
  const auto person = [](double along, double across) {
    const Eigen::Vector3d sigma(across, across, along);
    Person seen{PersonId{1}, {}};
    for (const int sensor : {1, 2}) {
      SensorView& view = seen.views.emplace_back(neck_view(sensor, {0, 1, 0}, 0.5, {0, 1, 3}));
      view.skeleton[JointId::Neck].covariance =
          Covariance(Eigen::Matrix3d(sigma.cwiseProduct(sigma).asDiagonal()));
    }
    return seen;
  };
  FusionConfig config;
  config.method = Method::BodyFilter;
  EXPECT_EQ(method_for(person(0.25, 0.025), config), Method::PointsAndRays);
  EXPECT_EQ(method_for(person(0.03, 0.015), config), Method::BodyFilter);
  const Person unstated{PersonId{1}, {neck_view(1, {0, 1, 0}, 0.5, {0, 1, 3})}};
  EXPECT_EQ(method_for(unstated, config), Method::BodyFilter);
  config.method = Method::Mean;
  EXPECT_EQ(method_for(person(0.25, 0.025), config), Method::Mean);
}

/// However uncertain its depth is, a point states a position; only rays can leave a joint without
/// one.
TEST(PointsAndRays, APointOfGuessedDepthStaysSeenInTheBodyFilter) {
  SensorView guessed = neck_view(1, {0, 1, 0}, 0.5, {0, 1, 3});
  guessed.skeleton[JointId::Neck].covariance =
      Covariance(Eigen::Matrix3d(Eigen::Vector3d(4e-4, 4e-4, 0.16).asDiagonal()));
  SensorView precise = neck_view(2, {0, 1.2, 0}, 0.5, {3, 1, 0});
  std::swap(precise.skeleton[JointId::Head], precise.skeleton[JointId::Neck]);
  Cell cell;
  cell.config.method = Method::BodyFilter;
  const FusedBody body = cell.at(milliseconds(0), {guessed, precise});
  EXPECT_TRUE(body.skeleton[JointId::Head].seen());
  EXPECT_TRUE(body.skeleton[JointId::Neck].seen());
}

/// A covariance of rank one that was rounded to floats can have eigenvalues below 0.
TEST(StatedCovariance, CanBeInvertedHoweverThinItIs) {
  const Eigen::Vector3d depth = Eigen::Vector3d(0.3, 0.5, 0.81).normalized();
  SensorView view = neck_view(1, {0, 1, 0}, 0.5);
  for (const double sigma : {0.3, 3.0, 10.0}) {
    view.skeleton[JointId::Neck].covariance =
        Covariance(Eigen::Matrix3d(sigma * sigma * depth * depth.transpose()));
    const Eigen::Matrix3d used = line_of_sight_errors({}, {})->covariance(view, JointId::Neck);
    EXPECT_EQ(used.llt().info(), Eigen::Success) << sigma;
    EXPECT_NEAR(used.trace(), sigma * sigma, 1e-3 * sigma * sigma);
  }
}

TEST(PointsAndRays, AnswersForPeopleOfWhomThereAreRaysAloneWhateverTheMethod) {
  const Eigen::Vector3d neck(0.2, 1.4, 0.1);
  Cell cell;
  cell.config = {};
  cell.config.method = Method::InverseVariance;
  const FusedBody rays = cell.at(milliseconds(0), {ray_view(1, neck), ray_view(2, neck)});
  EXPECT_LT((rays.skeleton[JointId::Neck].position - neck).norm(), 1e-9);
  EXPECT_EQ(rays.contributors[kNeck], 0b11U);
  // Where a view has a point, the configured method decides.
  const FusedBody both = cell.at(
      milliseconds(33), {ray_view(1, neck), ray_view(2, neck), neck_view(3, neck, 0.5, {0, 1, 3})});
  EXPECT_EQ(both.contributors[kNeck], 0b100U);
  // Each method keeps its own memory: points-and-rays knows the neck from before, so one ray is
  // enough.
  (void)cell.at(milliseconds(66), {ray_view(1, neck)});
  EXPECT_EQ(cell.at(milliseconds(66), {ray_view(1, neck)}).contributors[kNeck], 0b1U);
}

TEST(PointsAndRays, ASingleRayMakesNoJoint) {
  Cell cell;
  const FusedBody body = cell.at(milliseconds(0), {ray_view(1, {0, 1.4, 0})});
  EXPECT_EQ(body.skeleton[JointId::Neck].state, JointState::NotTracked);
  EXPECT_EQ(body.contributors[kNeck], 0U);
}

TEST(PointsAndRays, TheLastPlaceBoundsASingleRayForAWhile) {
  Cell cell;
  const auto neck = [](int i) { return Eigen::Vector3d(0.01 * i, 1.4, 0); };
  double before = 0.0;
  for (int i = 0; i < 30; ++i)
    before =
        cell.at(milliseconds(33 * i), {ray_view(1, neck(i)), ray_view(2, neck(i))}).variance[kNeck];
  const FusedBody alone = cell.at(milliseconds(33 * 31), {ray_view(1, neck(31))});
  EXPECT_LT((alone.skeleton[JointId::Neck].position - neck(31)).norm(), 0.01);
  EXPECT_EQ(alone.skeleton[JointId::Neck].state, JointState::Inferred);
  EXPECT_EQ(alone.contributors[kNeck], 0b01U);
  EXPECT_GT(alone.variance[kNeck], before);
  EXPECT_EQ(
      cell.at(milliseconds(33 * 30 + 400), {ray_view(1, neck(30))}).skeleton[JointId::Neck].state,
      JointState::NotTracked);
}

TEST(PointsAndRays, AJointThatNoViewShowsIsNotPredicted) {
  Cell cell;
  const Eigen::Vector3d neck(0.2, 1.4, 0.1);
  EXPECT_TRUE(cell.at(milliseconds(0), {ray_view(1, neck), ray_view(2, neck)})
                  .skeleton[JointId::Neck]
                  .seen());
  EXPECT_FALSE(
      cell.at(milliseconds(33), {neck_view(1, {0, 0, 0}, 0.5)}).skeleton[JointId::Head].seen());
}

TEST(PointsAndRays, RaysThatLeaveTheDepthOpenMakeNoJoint) {
  Cell cell;
  const Eigen::Vector3d neck(0, 1.4, 0);
  SensorView beside = ray_view(1, neck);
  beside.sensor = sensor(2);
  beside.eye += Eigen::Vector3d(0.05, 0, 0);
  beside.skeleton[JointId::Neck].position = (neck - beside.eye).normalized();
  EXPECT_FALSE(
      cell.at(milliseconds(0), {ray_view(1, neck), beside}).skeleton[JointId::Neck].seen());
  cell.config.max_sigma = 100.0;
  const FusedBody open = cell.at(milliseconds(0), {ray_view(1, neck), beside});
  EXPECT_TRUE(open.skeleton[JointId::Neck].seen());
  EXPECT_GT(open.variance[kNeck], 0.25);
}

TEST(PointsAndRays, PointsAndRaysWorkTogether) {
  Cell cell;
  const Eigen::Vector3d neck(0.2, 1.4, 0.1);
  const FusedBody body = cell.at(milliseconds(0), {neck_view(1, neck, 0.5), ray_view(2, neck)});
  EXPECT_LT((body.skeleton[JointId::Neck].position - neck).norm(), 1e-9);
  EXPECT_EQ(body.contributors[kNeck], 0b11U);
  EXPECT_TRUE(body.skeleton[JointId::Neck].orientation.isApprox(Eigen::Quaterniond::Identity()));
}

/// Of a neck between two rays that state an error of `sigma` [rad], the landmark's own included.
double stated_by_rays(double sigma) {
  Cell cell;
  cell.config.common_sigma = 0.0;
  const Eigen::Vector3d neck(0.2, 1.4, 0.1);
  std::vector views{ray_view(1, neck), ray_view(2, neck)};
  for (SensorView& view : views)
    view.skeleton[JointId::Neck].covariance =
        Covariance(Eigen::Matrix3d(sigma * sigma * Eigen::Matrix3d::Identity()));
  return std::sqrt(cell.at(milliseconds(0), views).variance[kNeck]);
}

TEST(PointsAndRays, ARayBelievesItsOwnCovariance) {
  const auto of_rays = [](double sigma) {
    const double landmark = landmark_error(JointId::Neck);
    return std::sqrt(square(stated_by_rays(sigma)) - square(landmark));
  };
  EXPECT_NEAR(of_rays(0.02) / of_rays(0.01), 2.0, 0.1);
  EXPECT_NEAR(of_rays(0.02), 0.055, 0.01) << "0.06 m at 3 m, twice";
}

/// Cameras that meet exactly for a while are believed to err by less than they state.
TEST(PointsAndRays, RaysThatMeetCloselyAreSaidToErrLess) {
  Cell cell;
  const Eigen::Vector3d neck(0.2, 1.4, 0.1);
  const std::vector views{ray_view(1, neck), ray_view(2, neck), ray_view(3, neck)};
  const double landmark = square(landmark_error(JointId::Neck));
  const double first = cell.at(milliseconds(0), views).variance[kNeck] - landmark;
  double last = first;
  for (int i = 1; i <= 300; ++i)
    last = cell.at(milliseconds(33 * i), views).variance[kNeck] - landmark;
  EXPECT_LT(last, 0.5 * first);
}

TEST(PointsAndRays, NoNumberOfCamerasKnowsAJointBetterThanItsLandmark) {
  EXPECT_GT(stated_by_rays(0.001), landmark_error(JointId::Neck));
  EXPECT_LT(stated_by_rays(0.001), 1.1 * landmark_error(JointId::Neck));
  Cell cell;
  const Eigen::Vector3d neck(0.2, 1.4, 0.1);
  SensorView depth = neck_view(3, neck, 0.5, {0, 1, 3});
  depth.skeleton[JointId::Neck].covariance =
      Covariance(Eigen::Matrix3d(2.5e-5 * Eigen::Matrix3d::Identity()));
  EXPECT_LT(std::sqrt(cell.at(milliseconds(0), {depth, ray_view(1, neck)}).variance[kNeck]), 0.01)
      << "a depth sensor's joint is its own";
  EXPECT_GT(landmark_error(JointId::ThumbLeft), landmark_error(JointId::SpineMid));
}

}  // namespace
}  // namespace chorus::fusion
