#include "fusion-server/watch/shift_test.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

namespace chorus::watch {
namespace {

/// Prior standard deviation of window means [m], and the number of windows that it counts as.
constexpr double kFirstSigma = 0.010;
constexpr double kFirstWeight = 60.0;
/// Scatter is remembered for about this many blocks, half an hour of walking.
constexpr double kMostWeight = 3600.0;

/// A block that is farther off than this counts as being this far off [m].
constexpr double kMostNews = 0.1;
/// Part of the shift that each half of a window must show.
constexpr double kLasting = 0.5;

struct Mean {
  Eigen::Vector3d news = Eigen::Vector3d::Zero();
  /// The mean of the blocks, with each block limited to kMostNews.
  Eigen::Vector3d limited = Eigen::Vector3d::Zero();
  Rows rows = Rows::Zero();
  std::set<SensorId> others;
};

using Blocks = std::deque<Block>::const_iterator;

Mean mean_of(Blocks begin, Blocks end, const StandingError& usual) {
  Mean mean;
  for (auto block = begin; block != end; ++block) {
    const Eigen::Vector3d news = usual.news(*block);
    mean.news += news;
    mean.limited += news * std::min(1.0, kMostNews / std::max(news.norm(), kMostNews));
    mean.rows += block->rows;
    mean.others.insert(block->others.begin(), block->others.end());
  }
  const auto count = static_cast<double>(end - begin);
  mean.news /= count;
  mean.limited /= count;
  mean.rows /= count;
  return mean;
}

/// True if each half of the window shows at least kLasting of the shift.
bool lasts(Blocks begin, Blocks end, const StandingError& usual, const Eigen::Vector3d& shift) {
  const auto middle = begin + (end - begin) / 2;
  const double whole = shift.squaredNorm();
  return mean_of(begin, middle, usual).limited.dot(shift) >= kLasting * whole &&
         mean_of(middle, end, usual).limited.dot(shift) >= kLasting * whole;
}

}  // namespace

ShiftTest::ShiftTest() {
  scatter_.fill(
      {kFirstWeight * kFirstSigma * kFirstSigma * Eigen::Matrix3d::Identity(), kFirstWeight});
}

Shift ShiftTest::test(const std::deque<Block>& recent, const StandingError& usual,
                      double learn_below) {
  Shift worst;
  for (std::size_t i = 0; i < kWindows.size(); ++i) {
    if (recent.size() < kWindows[i]) break;
    const auto begin = recent.end() - static_cast<std::ptrdiff_t>(kWindows[i]);
    Mean mean = mean_of(begin, recent.end(), usual);
    const Eigen::Vector3d& e = mean.limited;
    Scatter& scatter = scatter_[i];
    const Eigen::Matrix3d own = scatter.squares / scatter.weight;
    const Eigen::Matrix3d spread = own + usual.uncertainty(mean.rows);
    const double sigmas = std::sqrt(std::max(0.0, e.dot(spread.ldlt().solve(e))));
    if (sigmas < learn_below) {
      const double keep = std::min(1.0, kMostWeight / (scatter.weight + 1.0));
      // Only this part is due to scatter; the rest is the uncertainty of the usual error.
      const double part = own.trace() / spread.trace();
      scatter.squares = keep * (scatter.squares + part * e * e.transpose());
      scatter.weight = keep * (scatter.weight + 1.0);
    }
    const bool lasting = lasts(begin, recent.end(), usual, e);
    if (std::pair(lasting, sigmas) <= std::pair(worst.lasting, worst.sigmas)) continue;
    worst = {mean.news, sigmas, lasting, begin->begin, std::move(mean.others)};
  }
  return worst;
}

}  // namespace chorus::watch
