#include "common/body/covariance.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace chorus {
namespace {

constexpr double kWireRounding = 1e-7;  // bounds the rounding errors of six terms with 8 decimals

/// Sylvester's criterion: all leading minors are positive.
bool is_positive_definite(const Eigen::Matrix3d& c) {
  return c(0, 0) > 0 && c(0, 0) * c(1, 1) > c(0, 1) * c(0, 1) && c.determinant() > 0;
}

}  // namespace

Covariance::Covariance(const Eigen::Matrix3d& matrix)
    : Covariance(std::array<double, kTerms>{matrix(0, 0), matrix(0, 1), matrix(0, 2), matrix(1, 1),
                                            matrix(1, 2), matrix(2, 2)}) {}

Covariance::Covariance(const std::array<double, kTerms>& upper) : known_(true) {
  std::transform(upper.begin(), upper.end(), upper_.begin(),
                 [](double term) { return static_cast<float>(term); });
}

Eigen::Matrix3d Covariance::matrix() const {
  Eigen::Matrix3d full;
  full << term(0), term(1), term(2),  //
      term(1), term(3), term(4),      //
      term(2), term(4), term(5);
  return full;
}

Covariance Covariance::turned(const Eigen::Matrix3d& rotation) const {
  if (!known_) return {};
  return Covariance(Eigen::Matrix3d(rotation * matrix() * rotation.transpose()));
}

bool Covariance::plausible() const {
  const bool finite =
      std::all_of(upper_.begin(), upper_.end(), [](float term) { return std::isfinite(term); });
  if (!finite) return false;
  const Eigen::Matrix3d full = matrix();
  // Most matrices pass here; computing eigenvalues would take longer than writing the joint does.
  if (is_positive_definite(full + kWireRounding * Eigen::Matrix3d::Identity())) return true;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(full, Eigen::EigenvaluesOnly);
  const double largest = solver.eigenvalues().cwiseAbs().maxCoeff();
  return solver.eigenvalues().minCoeff() >= -kWireRounding - 1e-5 * largest;
}

Covariance between(const Covariance& a, const Covariance& b, double share) {
  if (!a.known() || !b.known()) return {};
  return Covariance(Eigen::Matrix3d((1.0 - share) * a.matrix() + share * b.matrix()));
}

}  // namespace chorus
