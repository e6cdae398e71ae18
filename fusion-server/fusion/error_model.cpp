#include "fusion-server/fusion/error_model.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace chorus::fusion {
namespace {

constexpr double kMinSigma =
    1e-4;  ///< [m], [rad]; prevents a division by zero if the configuration is careless
/// Least standard deviation of a stated covariance [m], [rad].  Nobody knows better where a joint
/// is inside a person, and a sensor that claims it would outvote any number of others.
constexpr double kLeastStated = 3e-3;
constexpr double kLeastStatedRay = 1e-3;
constexpr double kMinFactor = 1.0;  ///< an inferred joint is never better than a tracked one
constexpr double kMinRay = 1e-3;    ///< [m]; closer to the eye, a joint has no line of sight

double usable(double sigma, double factor) {
  return sigma > kMinSigma ? sigma * factor : kMinSigma * factor;
}

double factor_of(const Joint& joint, const NoiseModel& noise) {
  const bool inferred = joint.state == JointState::Inferred;
  return inferred ? std::max(kMinFactor, noise.inferred_factor) : kMinFactor;
}

/// Isotropic, although only the part across the ray is used.
Eigen::Matrix3d ray_covariance(const Joint& joint, const NoiseModel& noise) {
  const double sigma = usable(noise.ray, factor_of(joint, noise));
  return sigma * sigma * Eigen::Matrix3d::Identity();
}

/// A stated covariance, widened so that no direction is better known than `least` (standard
/// deviation) and it can be inverted.  Rounding on the wire leaves eigenvalues slightly below 0
/// where a sensor states that one direction is hardly known.
Eigen::Matrix3d believable(const Eigen::Matrix3d& stated, double least) {
  constexpr double kLeastRatio = 1e-7;  // of the smallest to the largest eigenvalue
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(stated, Eigen::EigenvaluesOnly);
  const double largest = solver.eigenvalues().cwiseAbs().maxCoeff();
  const double lack = std::max(0.0, least * least - solver.eigenvalues().minCoeff());
  return stated +
         (lack + kMinSigma * kMinSigma + kLeastRatio * largest) * Eigen::Matrix3d::Identity();
}

class LineOfSightErrors final : public ErrorModel {
 public:
  LineOfSightErrors(const NoiseModel& noise, const std::map<SensorId, NoiseModel>& of_sensors)
      : noise_(noise), of_sensors_(of_sensors) {}

  [[nodiscard]] JointError error(const SensorView& view, JointId id) const override {
    const Joint& joint = view.skeleton[id];
    if (joint.covariance.known()) {
      return {believable(joint.covariance.matrix(), joint.bears() ? kLeastStatedRay : kLeastStated),
              true};
    }
    const auto own = of_sensors_.find(view.sensor);
    const NoiseModel& noise = own == of_sensors_.end() ? noise_ : own->second;
    if (joint.bears()) return {ray_covariance(joint, noise), false};
    return {line_of_sight_covariance(joint, view.eye, noise), false};
  }

 private:
  NoiseModel noise_;
  std::map<SensorId, NoiseModel> of_sensors_;
};

}  // namespace

Eigen::Matrix3d line_of_sight_covariance(const Joint& joint, const Eigen::Vector3d& eye,
                                         const NoiseModel& noise) {
  const double factor = factor_of(joint, noise);
  const double along = usable(noise.along, factor);
  const double across = usable(noise.across, factor);
  const Eigen::Matrix3d round = across * across * Eigen::Matrix3d::Identity();
  if (along == across) return round;
  const Eigen::Vector3d ray = joint.position - eye;
  const double length = ray.norm();
  if (!(length > kMinRay) || !std::isfinite(length)) return round;
  const Eigen::Vector3d r = ray / length;
  return round + (along * along - across * across) * r * r.transpose();
}

std::unique_ptr<const ErrorModel> line_of_sight_errors(
    const NoiseModel& noise, const std::map<SensorId, NoiseModel>& of_sensors) {
  return std::make_unique<LineOfSightErrors>(noise, of_sensors);
}

}  // namespace chorus::fusion
