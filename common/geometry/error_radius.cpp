#include "common/geometry/error_radius.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace chorus {
namespace {

/// 95 % radius / sigma of the long axis, for short axes of 0, 0.1, ... 1 times the long one.
constexpr std::array kRadii{1.960, 1.963, 1.972, 1.991, 2.021, 2.064,
                            2.121, 2.191, 2.271, 2.357, 2.4477};

}  // namespace

double radius_of_95(const Eigen::Matrix2d& covariance) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  constexpr double kRounding = 1e-9;  // relative to the largest term
  if (!covariance.allFinite()) return kUnknown;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance, Eigen::EigenvaluesOnly);
  if (axes.eigenvalues()[0] < -kRounding * covariance.cwiseAbs().maxCoeff()) return kUnknown;
  const double wide = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
  if (!(wide > 0)) return 0.0;
  const double narrow = std::sqrt(std::max(0.0, axes.eigenvalues()[0]));
  const double step = std::min(1.0, narrow / wide) * static_cast<double>(kRadii.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(step), kRadii.size() - 2);
  const double rest = step - static_cast<double>(below);
  return wide * std::lerp(kRadii[below], kRadii[below + 1], rest);
}

double radius_on_floor(const Eigen::Matrix<double, 6, 6>& covariance) {
  return radius_of_95(covariance.block<3, 3>(3, 3)({0, 2}, {0, 2}));
}

}  // namespace chorus
