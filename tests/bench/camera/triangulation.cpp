#include "tests/bench/camera/triangulation.h"

#include <cmath>

#include <Eigen/LU>

#include "common/base/units.h"

namespace chorus::bench {
namespace {

constexpr double kInlier = deg(1.5);
constexpr double kScale = deg(0.5);
constexpr int kRounds = 10;

/// The point nearest to the rays, each with a weight per square metre.
std::optional<Eigen::Vector3d> nearest_point(const std::vector<SeenAlong>& rays,
                                             const std::vector<double>& weights) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - rays[i].direction * rays[i].direction.transpose();
    matrix += weights[i] * across;
    right += weights[i] * across * rays[i].eye;
  }
  if (!(matrix.determinant() > 1e-12)) return std::nullopt;
  return Eigen::Vector3d(matrix.inverse() * right);
}

/// Angle between a ray and the direction to a point; pi for a point behind the camera.
double angle_to(const SeenAlong& ray, const Eigen::Vector3d& point) {
  const Eigen::Vector3d way = point - ray.eye;
  return std::atan2(ray.direction.cross(way).norm(), ray.direction.dot(way));
}

std::size_t count_inliers(const std::vector<SeenAlong>& rays, const Eigen::Vector3d& point) {
  std::size_t count = 0;
  for (const SeenAlong& ray : rays) count += angle_to(ray, point) < kInlier ? 1 : 0;
  return count;
}

std::optional<Eigen::Vector3d> point_of_most(const std::vector<SeenAlong>& rays) {
  std::optional<Eigen::Vector3d> best;
  std::size_t most = 1;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (std::size_t k = i + 1; k < rays.size(); ++k) {
      const auto point = nearest_point({rays[i], rays[k]}, {1.0, 1.0});
      if (!point) continue;
      const std::size_t inliers = count_inliers(rays, *point);
      if (inliers <= most) continue;
      most = inliers;
      best = point;
    }
  }
  return best;
}

}  // namespace

std::optional<Eigen::Vector3d> triangulated(const std::vector<SeenAlong>& rays) {
  auto point = point_of_most(rays);
  for (int round = 0; point && round < kRounds; ++round) {
    std::vector<double> weights;
    for (const SeenAlong& ray : rays) {
      const double off = angle_to(ray, *point) / kScale;
      weights.push_back(1.0 / ((1.0 + off * off) * (*point - ray.eye).squaredNorm()));
    }
    point = nearest_point(rays, weights);
  }
  return point;
}

}  // namespace chorus::bench
