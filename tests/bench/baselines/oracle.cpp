#include "tests/bench/baselines/oracle.h"

#include <algorithm>
#include <limits>

namespace chorus::bench::baselines {
namespace {

constexpr int kMostRounds = 500;
constexpr double kGap = 1e-8;          // [m^2] of half the squared distance, left at most
constexpr double kLeastError = 0.001;  // [m] nobody is weighted as if exact

/// A mean under way: weights that sum to one, and where they put it.
struct Mean {
  std::span<const Eigen::Vector3d> points;
  std::vector<double> weights;
  Eigen::Vector3d place;

  /// The vertex that leads furthest along `way`, and the used one that leads least.
  [[nodiscard]] std::pair<std::size_t, std::size_t> best_exchange(const Eigen::Vector3d& way) const;
};

std::pair<std::size_t, std::size_t> Mean::best_exchange(const Eigen::Vector3d& way) const {
  std::size_t to = 0;
  std::size_t from = points.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (way.dot(points[i]) > way.dot(points[to])) to = i;
    if (weights[i] <= 0) continue;
    if (from == points.size() || way.dot(points[i]) < way.dot(points[from])) from = i;
  }
  return {to, from};
}

/// Each joint by itself, of those views that saw it.
template <class Combine>
Body joint_by_joint(const Person& person, const Body& exact, const Combine& combine) {
  Body body;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    std::vector<Eigen::Vector3d> points;
    Joint& joint = body.joints[j];
    for (const SensorView& view : person.views) {
      const Joint& seen = view.skeleton.joints[j];
      if (!seen.seen()) continue;
      points.push_back(seen.position);
      joint.state = std::max(joint.state, seen.state);
    }
    if (!points.empty()) joint.position = combine(points, exact.joints[j].position);
  }
  return body;
}

}  // namespace

Eigen::Vector3d nearest_in_hull(std::span<const Eigen::Vector3d> points,
                                const Eigen::Vector3d& target) {
  if (points.empty()) {
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  // Frank-Wolfe with pairwise steps: weight moves from the worst used point to the best one.
  Mean mean{points, std::vector<double>(points.size(), 0.0), points.front()};
  mean.weights.front() = 1.0;
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::Vector3d way = target - mean.place;
    const auto [to, from] = mean.best_exchange(way);
    const Eigen::Vector3d step = points[to] - points[from];
    const double gain = way.dot(step);
    if (!(gain > kGap)) break;
    const double share = std::min(mean.weights[from], gain / step.squaredNorm());
    mean.weights[to] += share;
    mean.weights[from] = share < mean.weights[from] ? mean.weights[from] - share : 0.0;
    mean.place += share * step;
  }
  return mean.place;
}

Body nearest_mean(const Person& person, const Body& exact) {
  return joint_by_joint(person, exact, [](const auto& points, const Eigen::Vector3d& target) {
    return nearest_in_hull(points, target);
  });
}

Body error_weighted_mean(const Person& person, const Body& exact) {
  return joint_by_joint(person, exact, [](const auto& points, const Eigen::Vector3d& target) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0.0;
    for (const Eigen::Vector3d& point : points) {
      const double error = std::max(kLeastError, (point - target).norm());
      sum += point / (error * error);
      weights += 1.0 / (error * error);
    }
    return Eigen::Vector3d(sum / weights);
  });
}

}  // namespace chorus::bench::baselines
