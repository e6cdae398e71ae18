// Estimates from the residuals how far successive measurements are from independent.
//
// A least-squares estimate with information H, sum of scores g = 0 and independent measurements has
// the covariance H^-1.  Errors of joints persist over many frames, so the scores of one block of
// time add up.  With g_b and H_b the score and the information of block b, H = sum H_b, the factor
//   v = sum_b g_b^T H^-1 g_b / (dim - sum_b tr((H^-1 H_b)^2))
// is what H^-1 has to be multiplied by: the scalar form of the cluster-robust (sandwich)
// covariance, where the denominator accounts for what the fit has removed from each block.  Scores
// are those of the walk's own best fit, g_b - H_b H^-1 sum g: if a floor pulls the estimate away
// from it, the walk must not be trusted less for that, or the floor would pull ever further.
// Derived in docs/papers/registration.md, Section 4.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace chorus::registration {

/// Scores and information of a walk, by blocks of time.
class BlockScores {
 public:
  /// Blocks last 2 s, or a quarter of a walk shorter than 8 s.  `length`: that of the walk [s].
  explicit BlockScores(double length);

  /// Index of the block that contains the instant `time` [s].
  [[nodiscard]] long index(double time) const;
  /// Adds one whole block.
  void add(Eigen::MatrixXd information, Eigen::VectorXd score);

  /// Prior knowledge about the factor.
  struct Prior {
    double factor = 1.0;   ///< The factor expected before looking at the blocks.
    double freedom = 0.0;  ///< How many degrees of freedom of the blocks it counts for.
  };
  /// The factor v over some of the parameters, with the others held, averaged with the prior; the
  /// prior alone if there are fewer than two blocks. Blocks shorter than 2 s do not show errors
  /// that last 2 s, so the sum over them is multiplied by 2 s / the length of one.
  [[nodiscard]] double factor(std::span<const Eigen::Index> parameters, const Prior& prior) const;

 private:
  struct Block {
    Eigen::MatrixXd information;
    Eigen::VectorXd score;
  };

  double length_ = 2.0;  ///< Length of a block [s].
  std::vector<Block> blocks_;
};

}  // namespace chorus::registration
