#include "tests/bench/positioner/position_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace chorus::bench {
namespace {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

PlaceScores scores_of(const std::vector<FoundPlace>& found,
                      const std::vector<Eigen::Vector3d>& truth, const Eigen::Vector3d& eye) {
  PlaceScores out;
  std::vector<double> errors;
  double squares = 0.0;
  double along_squares = 0.0;
  double across_squares = 0.0;
  for (std::size_t i = 0; i < std::min(found.size(), truth.size()); ++i) {
    if (!found[i].place) continue;
    const Eigen::Vector3d off = *found[i].place - truth[i];
    const Eigen::Vector3d line = (truth[i] - eye).normalized();
    const Eigen::Vector3d level = Eigen::Vector3d::UnitY().cross(line).normalized();
    const Eigen::Vector3d steep = line.cross(level);
    errors.push_back(off.norm());
    squares += off.squaredNorm();
    const auto square = [&](const Eigen::Vector3d& axis) { return std::pow(axis.dot(off), 2); };
    const auto stated = [&](const Eigen::Vector3d& axis) {
      return std::max(1e-9, axis.dot(found[i].covariance * axis));
    };
    along_squares += square(line);
    across_squares += 0.5 * (square(level) + square(steep));
    out.nees_along += square(line) / stated(line);
    out.nees_across += 0.5 * (square(level) / stated(level) + square(steep) / stated(steep));
  }
  const double count = std::max(1.0, static_cast<double>(errors.size()));
  out.rms = std::sqrt(squares / count);
  out.rms_along = std::sqrt(along_squares / count);
  out.rms_across = std::sqrt(across_squares / count);
  out.nees_along /= count;
  out.nees_across /= count;
  out.median = quantile(errors, 0.5);
  out.p95 = quantile(errors, 0.95);
  out.answered = static_cast<double>(errors.size()) / static_cast<double>(truth.size());
  return out;
}

}  // namespace chorus::bench
