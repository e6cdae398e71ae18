#include "common/synthetic/depth/normal_equations.h"

#include <Eigen/Cholesky>

namespace chorus::synthetic::depth {

NormalEquations::NormalEquations() {
  left_.setZero();
  right_.setZero();
}

void NormalEquations::add(std::span<const Term> combination, const Eigen::Matrix3d& weight,
                          const Eigen::Vector3d& weighted_way) {
  for (const Term& row : combination) {
    right_.segment<3>(3 * row.node) += row.coefficient * weighted_way;
    for (const Term& column : combination) {
      if (column.node > row.node) continue;
      left_.block<3, 3>(3 * row.node, 3 * column.node) +=
          row.coefficient * column.coefficient * weight;
    }
  }
}

void NormalEquations::move_along(std::span<const Term> combination,
                                 const Eigen::Vector3d& direction, double way, double weight) {
  add(combination, weight * direction * direction.transpose(), weight * way * direction);
}

void NormalEquations::move(std::span<const Term> combination, const Eigen::Vector3d& way,
                           double weight) {
  add(combination, weight * Eigen::Matrix3d::Identity(), weight * way);
}

Nodes NormalEquations::solve() const {
  const Eigen::Matrix<double, kSize, 1> step =
      Eigen::LLT<Eigen::Matrix<double, kSize, kSize>, Eigen::Lower>(left_).solve(right_);
  Nodes steps = Nodes::Zero();
  if (step.allFinite()) steps = Eigen::Map<const Nodes>(step.data());
  return steps;
}

}  // namespace chorus::synthetic::depth
