// Tests the covariances of chains, extrinsics and edges.  Most are compared with J C J^T, where J
// is a numeric derivative (carried()).
#include <functional>

#include <gtest/gtest.h>

#include "fusion-server/registration/pair_registration.h"
#include "fusion-server/registration/transform_graph.h"
#include "tests/unit/registration/pair_cloud.h"
#include "tests/unit/registration/walk_builder.h"

namespace chorus::registration {
namespace {

const Eigen::Isometry3d kCovarianceTarget = ring_place(0);
const Eigen::Isometry3d kSource = ring_place(deg(180));

/// A covariance that differs in every direction, so that a missing or wrong rotation shows.
Matrix6 lopsided(double size) {
  Vector6 sigma;
  sigma << 1, 2, 3, 10, 20, 40;
  const Vector6 along = size * Vector6(sigma.array() * 1e-3);
  Matrix6 covariance = along.array().square().matrix().asDiagonal();
  covariance(0, 4) = covariance(4, 0) = 0.5 * along[0] * along[4];
  return covariance;
}

/// J C J^T for a motion with covariance C, where J is the numeric derivative of `effect` with
/// respect to the motion.
Matrix6 carried(const Matrix6& covariance, const std::function<Vector6(const Vector6&)>& effect) {
  constexpr double kStep = 1e-6;
  Matrix6 jacobian;
  for (int axis = 0; axis < 6; ++axis) {
    jacobian.col(axis) = (effect(unit6(axis, kStep)) - effect(unit6(axis, -kStep))) / (2.0 * kStep);
  }
  return jacobian * covariance * jacobian.transpose();
}

double relative_gap(const Matrix6& a, const Matrix6& b) { return (a - b).norm() / b.norm(); }

PairwiseRegistration edge_between(int target, int source, const Eigen::Isometry3d& place,
                                  double size) {
  PairwiseRegistration edge{sensor(target), sensor(source)};
  edge.target_from_source = place;
  edge.rms = 0.01;
  edge.pairs = edge.inliers = 100;
  edge.spread = 1.0;
  edge.covariance = lopsided(size);
  return edge;
}

TEST(ChainCovariance, OfAnEdgeWalkedBackwardsIsThatOfTheInverse) {
  const PairwiseRegistration edge = edge_between(0, 1, tilted_motion(), 1.0);
  const Chain back = best_chains(sensor(1), {edge}).at(sensor(0));
  const Matrix6 expected = carried(edge.covariance, [&](const Vector6& xi) {
    const Eigen::Isometry3d inverse = tilted_motion().inverse();
    return motion_of((small_motion(xi) * tilted_motion()).inverse() * inverse.inverse());
  });
  EXPECT_LT(relative_gap(back.covariance, expected), 1e-6);
  EXPECT_LT(gap(back.master_from_sensor, tilted_motion().inverse()), 1e-12);
}

TEST(ChainCovariance, OfTwoEdgesCarriesTheSecondOverTheFirst) {
  const PairwiseRegistration first = edge_between(0, 1, tilted_motion(), 1.0);
  const PairwiseRegistration second = edge_between(1, 2, some_motion(-0.4), 2.0);
  const Chain chain = best_chains(sensor(0), {first, second}).at(sensor(2));
  const Eigen::Isometry3d whole = first.target_from_source * second.target_from_source;
  const Matrix6 from_first = carried(first.covariance, [&](const Vector6& xi) {
    return motion_of(small_motion(xi) * whole * whole.inverse());
  });
  const Matrix6 from_second = carried(second.covariance, [&](const Vector6& xi) {
    return motion_of(first.target_from_source * small_motion(xi) * second.target_from_source *
                     whole.inverse());
  });
  EXPECT_LT(relative_gap(chain.covariance, from_first + from_second), 1e-6);
}

/// A registration whose only edge is the truth with this covariance.
Registration solved_with(const Matrix6& covariance) {
  const PairEstimator estimate = [&](const Walker& target, const Walker& source) {
    PairwiseRegistration edge = edge_between(1, 2, kCovarianceTarget.inverse() * kSource, 1.0);
    edge.target = target.trail.sensor;
    edge.source = source.trail.sensor;
    edge.covariance = covariance;
    return Result<PairwiseRegistration>(edge);
  };
  RegistrationConfig config;
  config.master = sensor(1);
  config.adjust_together = false;
  config.max_position = 1.0;
  const WalkSpec spec{.length = 2, .noise = 0.0};
  return solve_with(estimate, {watch(1, kCovarianceTarget, spec), watch(2, kSource, spec)},
                    kWalkStart, config);
}

TEST(ExtrinsicsCovariance, IsOfTheTurnAndTheSensorsPlaceInWorldAxes) {
  const Matrix6 of_edge = lopsided(1.0);
  const Registration registration = solved_with(of_edge);
  const Extrinsics& client = registration.sensors.at(sensor(2));
  const Eigen::Isometry3d world_from_master = registration.sensors.at(sensor(1)).world_from_sensor;
  const Eigen::Isometry3d master_from_client = kCovarianceTarget.inverse() * kSource;
  ASSERT_LT(gap(client.world_from_sensor, world_from_master * master_from_client), 1e-9);
  const Matrix6 expected = carried(of_edge, [&](const Vector6& xi) {
    const Eigen::Isometry3d off = world_from_master * small_motion(xi) * master_from_client;
    Vector6 effect;
    effect << log_map(
        Eigen::Quaterniond(off.linear() * client.world_from_sensor.linear().transpose())),
        off.translation() - client.world_from_sensor.translation();
    return effect;
  });
  EXPECT_LT(relative_gap(client.covariance, expected), 1e-6);
  EXPECT_EQ(registration.sensors.at(sensor(1)).covariance, Matrix6::Zero());
}

TEST(ExtrinsicsCovariance, DecidesWhetherAPlaceIsGoodEnough) {
  Matrix6 wide = Matrix6::Zero();
  wide.bottomRightCorner<3, 3>() = std::pow(mm(25), 2) * Eigen::Matrix3d::Identity();
  Matrix6 narrow = 0.36 * wide;  // 15 mm: a radius of 37 mm at 95 %
  const auto complaint = [](const Registration& registration) {
    for (const std::string& reason : registration.reasons) {
      if (reason.find("is placed only to within") != std::string::npos) return reason;
    }
    return std::string();
  };
  EXPECT_NE(complaint(solved_with(wide)).find("0.061 m"), std::string::npos);  // 25 mm * 2.4477
  EXPECT_EQ(complaint(solved_with(narrow)), "");
}

/// The edge between two sensors that see the same walk without any noise.
PairwiseRegistration edge_of(const Eigen::Isometry3d& target, const Eigen::Isometry3d& source) {
  const WalkSpec exact{.length = 6, .noise = 0.0};
  const auto edge = register_pair(watch(1, target, exact), watch(1, source, exact), {});
  return edge.value();
}

/// Subtracts the variance that stands for the bias between views from opposite sides; what remains
/// is the uncertainty that the walk leaves.
Matrix6 without_bias(Matrix6 covariance) {
  covariance.bottomRightCorner<3, 3>() -= std::pow(mm(10), 2) * Eigen::Matrix3d::Identity();
  return covariance;
}

TEST(EdgeCovariance, IsStatedInTheTargetsOwnAxesHoweverItIsTilted) {
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(deg(-15), Eigen::Vector3d::UnitX()));
  const Matrix6 tilted = without_bias(edge_of(kCovarianceTarget, kSource).covariance);
  const Matrix6 straight = without_bias(edge_of(kCovarianceTarget * turn, kSource).covariance);
  const Matrix6 expected = carried(tilted, [&](const Vector6& xi) {
    return motion_of(turn.inverse() * small_motion(xi) * turn);
  });
  EXPECT_LT(relative_gap(straight, expected), 1e-3);
  EXPECT_GT(relative_gap(straight, tilted), 0.02);
}

TEST(EdgeCovariance, HasAFloorThatGrowsWithTheAngleBetweenTheViews) {
  const auto position_sigma = [](double angle) {
    const Matrix6 covariance = edge_of(kCovarianceTarget, ring_place(deg(angle))).covariance;
    // States the covariance at the middle of the walk, where an exact walk leaves almost no error
    // of its own.
    const Matrix6 shift = at_point(Eigen::Vector3d(0, 0, 3.1));
    const Matrix6 there = shift * covariance * shift.transpose();
    return std::sqrt(there.bottomRightCorner<3, 3>().trace() / 3.0);
  };
  EXPECT_NEAR(to_mm(position_sigma(180)), 10.0, 1.0);
  EXPECT_NEAR(to_mm(position_sigma(120)), 10.0, 1.0);
  EXPECT_NEAR(to_mm(position_sigma(45)), 5.0, 1.0);
  EXPECT_LT(to_mm(position_sigma(0.5)), 1.5);
}

}  // namespace
}  // namespace chorus::registration
