#include "common/posture/spread.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Cholesky>

#include "common/geometry/rotation.h"

namespace chorus::posture {
namespace {

/// Standard normal deviates of one body: three for each joint.
using Deviates = std::array<Eigen::Vector3d, kJointCount>;

/// Box-Muller, so that every standard library draws the same.
std::array<Deviates, kDraws> fixed_deviates() {
  std::mt19937_64 random(32);
  const auto uniform = [&] {
    constexpr double kSteps = 9007199254740992.0;  // 2^53
    return (static_cast<double>(random() >> 11U) + 0.5) / kSteps;
  };
  std::array<Deviates, kDraws> all;
  for (std::size_t k = 0; k < kDraws; k += 2) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      for (int axis = 0; axis < 3; ++axis)
        all[k][j][axis] =
            std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * std::numbers::pi * uniform());
      all[k + 1][j] = -all[k][j];
    }
  }
  return all;
}

/// Rotation vectors, in pairs of opposite sign.
std::array<Eigen::Vector3d, kDraws> fixed_head_turns() {
  std::array<Eigen::Vector3d, kDraws> all;
  std::mt19937_64 random(33);
  const auto uniform = [&] { return (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53; };
  for (std::size_t k = 0; k < kDraws; k += 2) {
    for (int axis = 0; axis < 3; ++axis)
      all[k][axis] = kHeadTurn * std::sqrt(-2.0 * std::log(uniform())) *
                     std::cos(2.0 * std::numbers::pi * uniform());
    all[k + 1] = -all[k];
  }
  return all;
}

/// The square root of each joint's covariance; zero where it is not known.
struct Roots {
  std::array<Eigen::Matrix3d, kJointCount> of;
  std::size_t doubtless = 0;
};

Roots roots_of(const Skeleton<WorldSpace>& body) {
  Roots roots;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    roots.of[j].setZero();
    const Joint& joint = body.joints[j];
    if (!joint.seen()) continue;
    if (!joint.covariance.known() || !joint.covariance.plausible()) {
      ++roots.doubtless;
      continue;
    }
    const Eigen::LLT<Eigen::Matrix3d> root(joint.covariance.matrix());
    if (root.info() == Eigen::Success) roots.of[j] = root.matrixL();
  }
  return roots;
}

double difference(std::size_t measure, double a, double b) {
  return row_of(measure).unit == Unit::Angle ? wrap_angle(a - b) : a - b;
}

using Column = Eigen::Matrix<double, kMeasures, 1>;

Column differences(const Measures& a, const Measures& b) {
  Column column;
  for (std::size_t m = 0; m < kMeasures; ++m)
    column[static_cast<Eigen::Index>(m)] = difference(m, a.values[m], b.values[m]);
  return column;
}

}  // namespace

std::optional<Eigen::Quaterniond> head_of(const Skeleton<WorldSpace>& body) {
  const Joint& head = body[JointId::Head];
  if (!head.seen() || !is_unit(head.orientation)) return std::nullopt;
  return head.orientation;
}

Posture posture_of(const Skeleton<WorldSpace>& body) {
  return posture_of(points_of(body), head_of(body));
}

Spread spread_of(const Skeleton<WorldSpace>& body) {
  const double h2 = 3.0;  // Norgaard et al.: best for normal distributions
  const Roots roots = roots_of(body);
  const auto head = head_of(body);
  Located joints = points_of(body);
  const Measures centre = posture_of(joints, head).measures;
  Spread spread;
  spread.doubtless = roots.doubtless;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!joints[j] || roots.of[j].isZero(0.0)) continue;
    const Eigen::Vector3d place = *joints[j];
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = std::sqrt(h2) * roots.of[j].col(axis);
      joints[j] = place + step;
      const Column plus = differences(posture_of(joints, head).measures, centre);
      joints[j] = place - step;
      const Column minus = differences(posture_of(joints, head).measures, centre);
      const Column first = plus - minus;
      const Column second = plus + minus;
      spread.covariance += first * first.transpose() / (4.0 * h2);
      spread.covariance += second * second.transpose() * ((h2 - 1.0) / (4.0 * h2 * h2));
    }
    joints[j] = place;
  }
  for (std::size_t m = 0; m < kMeasures; ++m) {
    if (!std::isnan(centre.values[m])) continue;
    spread.covariance.row(static_cast<Eigen::Index>(m)).setConstant(std::nan(""));
    spread.covariance.col(static_cast<Eigen::Index>(m)).setConstant(std::nan(""));
  }
  return spread;
}

DrawnMeasures drawn_measures(const Skeleton<WorldSpace>& body, double share) {
  static const std::array<Deviates, kDraws> kDeviates = fixed_deviates();
  static const std::array<Eigen::Vector3d, kDraws> kHeadTurns = fixed_head_turns();
  const Roots roots = roots_of(body);
  const auto head = head_of(body);
  const Located joints = points_of(body);
  DrawnMeasures drawn;
  drawn.doubtless = roots.doubtless;
  for (std::size_t k = 0; k < kDraws; ++k) {
    Located moved = joints;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (moved[j]) *moved[j] += share * (roots.of[j] * kDeviates[k][j]);
    }
    const auto turned =
        head ? std::optional<Eigen::Quaterniond>(exp_map(kHeadTurns[k]) * *head) : std::nullopt;
    drawn.draws[k] = posture_of(moved, turned).measures;
  }
  return drawn;
}

}  // namespace chorus::posture
