#include "fusion-server/registration/block_variance.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace chorus::registration {
namespace {

constexpr double kBlock = 2.0;           // [s] errors of joints last 0.2 to 1 s
constexpr double kFewest = 4.0;          // least number of blocks of a walk
constexpr double kShortest = 0.1;        // [s]
constexpr double kLeast = 1e-6;          // least factor, and least denominator
constexpr double kRelativeRidge = 1e-9;  // relative, for what no measurement determines

}  // namespace

BlockScores::BlockScores(double length)
    : length_(std::clamp(length / kFewest, kShortest, kBlock)) {}

long BlockScores::index(double time) const { return static_cast<long>(std::floor(time / length_)); }

void BlockScores::add(Eigen::MatrixXd information, Eigen::VectorXd score) {
  blocks_.push_back({std::move(information), std::move(score)});
}

double BlockScores::factor(std::span<const Eigen::Index> parameters, const Prior& prior) const {
  const std::vector<Eigen::Index> chosen(parameters.begin(), parameters.end());
  const auto count = static_cast<Eigen::Index>(chosen.size());
  if (blocks_.size() < 2 || count == 0) return prior.factor;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(count, count);
  // The sum of the scores, which is not zero where something other than the walk pulls on the
  // estimate.
  Eigen::VectorXd left = Eigen::VectorXd::Zero(count);
  for (const Block& block : blocks_) {
    whole += block.information(chosen, chosen);
    left += block.score(chosen);
  }
  whole.diagonal().array() += kRelativeRidge * whole.diagonal().maxCoeff();
  const Eigen::LDLT<Eigen::MatrixXd> solver(whole);
  const Eigen::VectorXd own = solver.solve(left);
  double squares = 0.0;
  double freedom = static_cast<double>(count);
  for (const Block& block : blocks_) {
    const Eigen::VectorXd score = block.score(chosen) - block.information(chosen, chosen) * own;
    squares += score.dot(solver.solve(score));
    const Eigen::MatrixXd share = solver.solve(block.information(chosen, chosen));
    freedom -= share.cwiseProduct(share.transpose()).sum();  // tr(share^2)
  }
  squares *= kBlock / length_;
  const double factor =
      (squares + prior.freedom * prior.factor) / std::max(kLeast, freedom + prior.freedom);
  return std::isfinite(factor) ? std::max(kLeast, factor) : prior.factor;
}

}  // namespace chorus::registration
