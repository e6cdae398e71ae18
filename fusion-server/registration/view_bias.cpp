#include "fusion-server/registration/view_bias.h"

#include <array>
#include <cmath>

#include "common/base/units.h"
#include "fusion-server/registration/adjoint.h"

namespace chorus::registration {
namespace {

constexpr double kLevel = 1e-6;  // [m] a shorter horizontal part has no direction
constexpr Eigen::Index kTerms = 5;

using Terms = std::array<double, kTerms>;

Terms terms_of(const Eigen::Vector3d& view, const std::optional<Eigen::Vector3d>& walking) {
  if (!walking) return {1.0, 0.0, 0.0, 0.0, 0.0};
  const double phi = std::atan2(walking->x(), walking->z()) - std::atan2(-view.x(), -view.z());
  return {1.0, std::cos(phi), std::sin(phi), std::cos(2.0 * phi), std::sin(2.0 * phi)};
}

/// Columns: along the view, aside, upwards.
Eigen::Matrix3d axes_of(const Eigen::Vector3d& view) {
  Eigen::Matrix3d axes;
  axes.col(0) = view;
  axes.col(1) = Eigen::Vector3d::UnitY().cross(view);
  axes.col(2) = Eigen::Vector3d::UnitY();
  return axes;
}

}  // namespace

ViewBias::ViewBias(std::vector<Eigen::Vector3d> eyes, double coefficient)
    : eyes_(std::move(eyes)), coefficient_(coefficient) {
  const auto size = static_cast<Eigen::Index>(6 * eyes_.size() + 1);
  effects_.assign(eyes_.size(), Eigen::MatrixXd::Zero(size, 3 * kTerms));
}

void ViewBias::add(const PointMeasurements& measurements, const FusedPoint& fused, double weight,
                   const Eigen::Vector3d& at, const std::optional<Eigen::Vector3d>& walking) {
  std::vector<Eigen::Matrix<double, 6, 3>> pulls;  // J_j^T S_j^-1
  for (std::size_t j = 0; j < measurements.size(); ++j)
    pulls.push_back(derivative_of(measurements[j], fused.seen[j]).transpose() *
                    fused.information[j]);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const std::size_t sensor = measurements[i].sensor;
    Eigen::Vector3d view = at - eyes_[sensor];
    view.y() = 0.0;
    if (view.norm() < kLevel) continue;
    const Terms terms = terms_of(view, walking);
    // A measurement may be the difference of two sights in succession.  Their bias is the same, so
    // the difference contains only `lever` of it.
    const Eigen::Matrix3d axes = weight * measurements[i].lever * axes_of(view.normalized());
    const Eigen::Matrix3d share = fused.covariance * fused.information[i] * axes;
    for (std::size_t j = 0; j < measurements.size(); ++j) {
      const Eigen::Matrix3d off = i == j ? Eigen::Matrix3d(axes - share) : Eigen::Matrix3d(-share);
      const auto row = static_cast<Eigen::Index>(6 * measurements[j].sensor);
      for (Eigen::Index term = 0; term < kTerms; ++term) {
        effects_[sensor].block<6, 3>(row, 3 * term) +=
            terms[static_cast<std::size_t>(term)] * pulls[j] * off;
        effects_[sensor].block<1, 3>(effects_[sensor].rows() - 1, 3 * term) +=
            terms[static_cast<std::size_t>(term)] *
            (fused.information[j] * fused.nearer[j]).transpose() * off;
      }
    }
  }
}

Eigen::MatrixXd ViewBias::scores() const {
  const auto size = static_cast<Eigen::Index>(6 * eyes_.size() + 1);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
  for (const Eigen::MatrixXd& effect : effects_) sum += effect * effect.transpose();
  return coefficient_ * coefficient_ * sum;
}

}  // namespace chorus::registration
