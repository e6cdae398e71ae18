#include "fusion-server/watch/shift_test.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

namespace chorus::watch {
namespace {

/// Prior standard deviation of the medians [m], and the number of medians that it counts as.
constexpr double kFirstSigma = 0.012;
constexpr double kFirstWeight = 20.0;
/// Scatter is remembered for about this many blocks, half an hour of walking.
constexpr double kMostWeight = 3600.0;

static_assert(kWindow % 2 == 1, "the median is one of the values");

}  // namespace

ShiftTest::ShiftTest()
    : squares_(kFirstWeight * kFirstSigma * kFirstSigma * Eigen::Matrix3d::Identity()),
      weight_(kFirstWeight) {}

Shift ShiftTest::test(const std::deque<Block>& recent, const StandingError& usual,
                      double learn_below) {
  Shift shift;
  if (recent.size() < kWindow) return shift;
  const auto begin = recent.end() - static_cast<std::ptrdiff_t>(kWindow);
  Rows rows = Rows::Zero();
  std::array<std::array<double, kWindow>, 3> values{};
  for (std::size_t i = 0; i < kWindow; ++i) {
    const Block& block = begin[static_cast<std::ptrdiff_t>(i)];
    const Eigen::Vector3d news = usual.news(block);
    for (int axis = 0; axis < 3; ++axis) values[static_cast<std::size_t>(axis)][i] = news[axis];
    rows += block.rows / static_cast<double>(kWindow);
    shift.others.insert(block.others.begin(), block.others.end());
  }
  for (int axis = 0; axis < 3; ++axis) {
    auto& own = values[static_cast<std::size_t>(axis)];
    std::nth_element(own.begin(), own.begin() + kWindow / 2, own.end());
    shift.middle[axis] = own[kWindow / 2];
  }
  shift.since = begin->begin;
  const Eigen::Matrix3d scatter = squares_ / weight_;
  const Eigen::Matrix3d spread = scatter + usual.uncertainty(rows);
  shift.sigmas = std::sqrt(std::max(0.0, shift.middle.dot(spread.ldlt().solve(shift.middle))));
  if (shift.sigmas < learn_below) {
    const double keep = std::min(1.0, kMostWeight / (weight_ + 1.0));
    // Only this part is due to scatter; the rest is the uncertainty of the usual error.
    const double part = scatter.trace() / spread.trace();
    squares_ = keep * (squares_ + part * shift.middle * shift.middle.transpose());
    weight_ = keep * (weight_ + 1.0);
  }
  return shift;
}

}  // namespace chorus::watch
