#include "fusion-server/fusion/least_squares.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "fusion-server/fusion/inverse_variance.h"
#include "tests/unit/fusion/cameras.h"

namespace chorus::fusion {
namespace {

constexpr double kSquaresHuber = 1.5;
constexpr double kSigma = deg(0.3);
const Eigen::Vector3d kPoint(0.3, 1.1, -0.4);

JointView point_view(const Eigen::Vector3d& position, const Eigen::Vector3d& variance) {
  JointView view;
  view.joint.position = position;
  view.joint.state = JointState::Tracked;
  view.covariance = variance.asDiagonal();
  return view;
}

std::vector<JointView> rays_of(int cameras, RayDraw& draw) {
  std::vector<JointView> views;
  for (const Eigen::Vector3d& eye : camera_ring(cameras)) views.push_back(draw(eye, kPoint));
  return views;
}

/// Normalised squared error per axis.
double nees_of(const LeastSquares& found, const Eigen::Vector3d& truth) {
  const Eigen::Vector3d off = found.position - truth;
  return off.dot(found.covariance.inverse() * off) / 3.0;
}

TEST(LeastSquares, ExactRaysMeetInThePoint) {
  for (const int cameras : {2, 3, 5, 8}) {
    RayDraw exact(1, 0.0);
    const auto found = least_squares(rays_of(cameras, exact), kSquaresHuber);
    ASSERT_TRUE(found) << cameras;
    EXPECT_LT((found->position - kPoint).norm(), 1e-9) << cameras;
  }
}

TEST(LeastSquares, RaysThatMeetExactlyErrByTheirStatedAngles) {
  RayDraw exact(1, 0.0);
  std::vector views{exact({0, 1, -3}, {0, 1, 0}), exact({-3, 1, 0}, {0, 1, 0})};
  for (JointView& view : views) view.covariance = kSigma * kSigma * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d covariance = least_squares(views, kSquaresHuber)->covariance;
  const double one = 9.0 * kSigma * kSigma;  // [m^2], at 3 m
  EXPECT_NEAR(covariance(0, 0), one, 0.01 * one);
  EXPECT_NEAR(covariance(2, 2), one, 0.01 * one);
  EXPECT_NEAR(covariance(1, 1), one / 2.0, 0.01 * one) << "both cameras see the height";
}

TEST(LeastSquares, ANearCameraCountsMoreThanAFarOne) {
  // Two rays along z, one from 1 m and one from 4 m away, determine x; a ray along x determines z.
  std::vector<JointView> views;
  RayDraw exact(1, 0.0);
  views.push_back(exact({0, 0, -1}, {0, 0, 0}));
  views.push_back(exact({0.1, 0, -4}, {0.1, 0, 0}));
  views.push_back(exact({-2, 0, 0}, {0, 0, 0}));
  for (JointView& view : views) view.covariance = kSigma * kSigma * Eigen::Matrix3d::Identity();
  // Information is proportional to 1 / range^2: 0.1 / (1 + 16).
  EXPECT_NEAR(least_squares(views, 0.0)->position.x(), 0.1 / 17.0, 2e-4);
}

TEST(LeastSquares, StatesWhatTwoHundredDrawsErrBy) {
  for (const int cameras : {2, 3, 4, 8}) {
    RayDraw draw(static_cast<std::uint32_t>(cameras), kSigma);
    constexpr int kDraws = 200;
    double nees = 0.0;
    int inside = 0;
    for (int i = 0; i < kDraws; ++i) {
      const auto found = least_squares(rays_of(cameras, draw), kSquaresHuber);
      ASSERT_TRUE(found);
      const double one = nees_of(*found, kPoint);
      nees += one / kDraws;
      inside += 3.0 * one < 7.8147 ? 1 : 0;
    }
    EXPECT_GT(nees, 0.75) << cameras;
    EXPECT_LT(nees, 1.25) << cameras;
    EXPECT_GE(inside, 180) << cameras;
  }
}

TEST(LeastSquares, NoiseThatNobodyStatedShowsInTheScaleOfTheResiduals) {
  RayDraw draw(3, 5.0 * kSigma);
  double nees = 0.0;
  for (int i = 0; i < 200; ++i) {
    auto views = rays_of(8, draw);
    for (JointView& view : views) view.covariance /= 25.0;
    nees += nees_of(*least_squares(views, kSquaresHuber), kPoint) / 200;
  }
  EXPECT_LT(nees, 4.0) << "25 without the scale";
}

TEST(LeastSquares, OneCameraThatLooksElsewhereIsOutvoted) {
  RayDraw draw(5, kSigma);
  for (const int cameras : {4, 6, 8}) {
    auto views = rays_of(cameras, draw);
    views[1] = draw(views[1].eye, kPoint + Eigen::Vector3d(0.2, 0.8, 0.2));
    const auto found = least_squares(views, kSquaresHuber);
    ASSERT_TRUE(found);
    EXPECT_LT((found->position - kPoint).norm(), 0.03) << cameras;
    EXPECT_LT(found->trust[1], 0.1) << cameras;
    EXPECT_GT((least_squares(views, 0.0)->position - kPoint).norm(), 0.08) << "not robust";
  }
}

TEST(LeastSquares, ThreeOfEightCamerasThatAgreeOnAnotherPlaceAreOutvoted) {
  RayDraw draw(6, kSigma);
  auto views = rays_of(8, draw);
  for (const std::size_t i : {0U, 3U, 6U})
    views[i] = draw(views[i].eye, kPoint + Eigen::Vector3d(0.3, 0.2, 0.3));
  EXPECT_LT((least_squares(views, kSquaresHuber)->position - kPoint).norm(), 0.04);
}

TEST(LeastSquares, NearlyParallelRaysSayHowLittleTheyKnowOfTheDepth) {
  RayDraw draw(7, kSigma);
  const std::vector views{draw(camera_eye(0.0), kPoint), draw(camera_eye(deg(3)), kPoint)};
  const auto found = least_squares(views, kSquaresHuber);
  ASSERT_TRUE(found);
  const Eigen::Vector3d along = views[0].joint.position;
  EXPECT_GT(std::sqrt(along.dot(found->covariance * along)), 0.2);
  const Eigen::Vector3d aside = along.cross(Eigen::Vector3d::UnitY()).normalized();
  EXPECT_LT(std::sqrt(aside.dot(found->covariance * aside)), 0.03);
}

TEST(LeastSquares, OneRayOrParallelOnesMakeNoPoint) {
  RayDraw exact(1, 0.0);
  EXPECT_FALSE(least_squares({}, kSquaresHuber));
  EXPECT_FALSE(least_squares(std::vector{exact(camera_eye(0), kPoint)}, kSquaresHuber));
  const JointView one = exact(camera_eye(0), kPoint);
  EXPECT_FALSE(least_squares(std::vector{one, one}, kSquaresHuber));
}

TEST(LeastSquares, ACameraThatTheJointIsBehindIsNotBelieved) {
  RayDraw draw(8, kSigma);
  auto views = rays_of(3, draw);
  views.push_back(draw({1, 1, 0.2}, {2, 1, 1}));
  const auto found = least_squares(views, kSquaresHuber);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->trust[3], 0.0);
  EXPECT_LT((found->position - kPoint).norm(), 0.05);
}

TEST(LeastSquares, ARayMendsTheDepthOfAPoint) {
  // The point's depth sensor looks along z and is imprecise in that direction; a camera looks along
  // x.
  const JointView point = point_view({0, 1, 0.10}, {1e-4, 1e-4, 0.01});
  RayDraw exact(1, 0.0);
  JointView ray = exact({-3, 1, 0}, {0, 1, 0});
  ray.covariance = kSigma * kSigma * Eigen::Matrix3d::Identity();
  const auto found = least_squares(std::vector{point, ray}, kSquaresHuber);
  ASSERT_TRUE(found);
  EXPECT_LT(found->position.z(), 0.01);
  EXPECT_LT(found->covariance(2, 2), 5e-4);
}

TEST(LeastSquares, OfPointsAloneIsInverseVariance) {
  const std::vector views{point_view({0, 1, 0}, {1e-4, 1e-4, 9e-4}),
                          point_view({0.02, 1.01, 0}, {9e-4, 1e-4, 1e-4}),
                          point_view({0, 1, 0.03}, {4e-4, 4e-4, 4e-4})};
  const auto found = least_squares(views, kSquaresHuber);
  EXPECT_LT((found->position - inverse_variance(views, kSquaresHuber).joint.position).norm(), 1e-5);
}

}  // namespace
}  // namespace chorus::fusion
