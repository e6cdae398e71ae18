#include "common/geometry/ray.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace chorus {
namespace {

constexpr double kLeastSpread = 0.0038;  // 1 - cos 5 deg; below it the rays are nearly parallel.

double along(const Ray& ray, const Eigen::Vector3d& point) {
  return ray.direction.dot(point - ray.eye);
}

}  // namespace

Eigen::Vector3d nearest_on(const Ray& ray, const Eigen::Vector3d& point) {
  return ray.eye + std::max(0.0, along(ray, point)) * ray.direction;
}

double distance(const Ray& ray, const Eigen::Vector3d& point) {
  return (point - nearest_on(ray, point)).norm();
}

Eigen::Matrix3d across(const Eigen::Vector3d& direction) {
  return Eigen::Matrix3d::Identity() - direction * direction.transpose();
}

std::optional<Eigen::Vector3d> meeting_point(std::span<const Ray> rays) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Ray& ray : rays) {
    sum += across(ray.direction);
    right += across(ray.direction) * ray.eye;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(sum, Eigen::EigenvaluesOnly);
  if (!(solver.eigenvalues().minCoeff() > kLeastSpread)) return std::nullopt;
  return Eigen::Vector3d(sum.llt().solve(right));
}

std::optional<double> distance(const Ray& a, const Ray& b) {
  const auto meeting = meeting_point(std::array{a, b});
  if (!meeting || along(a, *meeting) <= 0 || along(b, *meeting) <= 0) return std::nullopt;
  return distance(a, *meeting) + distance(b, *meeting);
}

}  // namespace chorus
