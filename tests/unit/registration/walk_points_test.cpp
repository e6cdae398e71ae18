#include "fusion-server/registration/walk_points.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace chorus::registration {
namespace {

constexpr double kLag = 0.05;    // [s]
constexpr double kMemory = 0.4;  // [s]
constexpr std::size_t kCount = 4000;

/// A point that rests 2 m in front of two sensors at the same place, whose errors are remembered
/// for `memory`.
std::vector<WalkPoint> points_with(double memory) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.0, mm(10));
  const double alike = memory > 0.0 ? std::exp(-kLag / memory) : 0.0;
  const auto fresh = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random));
  };
  std::vector<Eigen::Vector3d> errors{fresh(), fresh()};
  std::vector<WalkPoint> points;
  for (std::size_t k = 0; k < kCount; ++k) {
    WalkPoint point{kLag * static_cast<double>(k), 0, {}, {}};
    for (std::size_t i = 0; i < 2; ++i) {
      errors[i] = alike * errors[i] + std::sqrt(1.0 - alike * alike) * fresh();
      point.seen.push_back(
          {i, Eigen::Vector3d(0, 0, 2) + errors[i], Eigen::Vector3d::UnitZ(), mm(10)});
    }
    point.counted = point.seen;
    points.push_back(std::move(point));
  }
  return points;
}

double found_memory(const std::vector<WalkPoint>& points) {
  const std::vector<Eigen::Isometry3d> places(3, Eigen::Isometry3d::Identity());
  std::vector<FusedPoint> fused;
  for (const WalkPoint& point : points) fused.push_back(fuse_point(point.seen, places, 1.0));
  return memory_of(points, fused, std::vector<double>(points.size(), 1.0));
}

TEST(MemoryOf, IsHowLongErrorsLast) {
  EXPECT_NEAR(found_memory(points_with(kMemory)), kMemory, 0.1 * kMemory);
  EXPECT_LT(found_memory(points_with(0.0)), kLag);
}

TEST(MemoryOf, OfPointsOfDifferentSlotsIsZero) {
  std::vector<WalkPoint> points = points_with(kMemory);
  for (std::size_t k = 0; k < points.size(); ++k) points[k].slot = k;
  EXPECT_EQ(found_memory(points), 0.0);
}

TEST(Whiten, LeavesWhatIsNewAndIndependent) {
  std::vector<WalkPoint> points = points_with(kMemory);
  whiten(points, kMemory);
  const double alike = std::exp(-kLag / kMemory);
  EXPECT_EQ(points[0].counted[1].x, points[0].seen[1].x);
  EXPECT_EQ(points[0].counted[1].lever, 1.0);
  const PointMeasurement& second = points[1].counted[1];
  EXPECT_LT((second.x - (points[1].seen[1].x - alike * points[0].seen[1].x)).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(second.lever, 1.0 - alike);
  double squares = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const PointMeasurement& each = points[k].counted[0];
    squares += std::pow(each.x.x() / each.sigma, 2);
  }
  EXPECT_NEAR(squares / static_cast<double>(kCount), 1.0, 0.1);
}

TEST(Whiten, CountsOnlySensorsThatSawBothAndNothingAcrossAGap) {
  std::vector<WalkPoint> points = points_with(kMemory);
  PointMeasurement third = points[1].seen[0];
  third.sensor = 2;
  points[1].seen.push_back(third);  // a third sensor joins in
  points[2].seen.erase(points[2].seen.begin());
  points[2].seen.push_back(third);  // and the first is gone
  points[3].time += 10.0;
  whiten(points, kMemory);
  EXPECT_EQ(points[1].counted.size(), 2u);
  EXPECT_EQ(points[2].counted[1].sensor, 2u);
  EXPECT_LT(points[2].counted[1].lever, 1.0);
  EXPECT_EQ(points[3].counted[0].lever, 1.0);
}

/// Between two points of a slot at the same instant nothing is new, so their difference would state
/// no error.
TEST(Whiten, PointsOfOneInstantKeepAnError) {
  std::vector<WalkPoint> points = points_with(kMemory);
  points[1].time = points[0].time;
  whiten(points, kMemory);
  EXPECT_GT(points[1].counted[0].sigma, 0.1 * points[1].seen[0].sigma);
  EXPECT_GT(points[1].counted[0].lever, 0.01);
}

TEST(Whiten, WithoutMemoryChangesNothing) {
  std::vector<WalkPoint> points = points_with(0.0);
  whiten(points, 0.0);
  EXPECT_EQ(points[1].counted[0].lever, 1.0);
}

}  // namespace
}  // namespace chorus::registration
