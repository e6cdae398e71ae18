// Normal equations of least squares for the nodes of the generic body: J^T W J and J^T W r.
#pragma once

#include <span>

#include "common/synthetic/depth/generic_body.h"

namespace chorus::synthetic::depth {

/// Coefficient of one node in a linear combination of nodes.
struct Term {
  Node node;
  double coefficient;
};

class NormalEquations {
 public:
  NormalEquations();

  /// Adds an equation: the combination of nodes moves by `way` [m] along the unit vector
  /// `direction`.
  void move_along(std::span<const Term> combination, const Eigen::Vector3d& direction, double way,
                  double weight);
  /// Adds three equations: the combination of nodes moves by `way` [m].
  void move(std::span<const Term> combination, const Eigen::Vector3d& way, double weight);

  /// The step of every node; zero if the equations have no finite solution.
  [[nodiscard]] Nodes solve() const;

 private:
  static constexpr int kSize = 3 * kNodeCount;

  void add(std::span<const Term> combination, const Eigen::Matrix3d& weight,
           const Eigen::Vector3d& weighted_way);

  /// Only the blocks on and below the diagonal are filled.
  Eigen::Matrix<double, kSize, kSize> left_;
  Eigen::Matrix<double, kSize, 1> right_;
};

}  // namespace chorus::synthetic::depth
