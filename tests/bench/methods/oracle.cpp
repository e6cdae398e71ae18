#include "tests/bench/methods/oracle.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace chorus::bench::baselines {
namespace {

constexpr double kMinError = 0.001;    // [m] limits the weight of a nearly exact joint view
constexpr double kMinVariance = 1e-6;  // [m^2] limits the mean square, too

/// A joint view with the true mean square of its error.
struct Sighting {
  Eigen::Vector3d place;
  Eigen::Matrix3d root;  ///< Symmetric root of the mean square [m].
  double bearing = 0.0;  ///< Of the sensor as seen from the joint, about +y [rad].
  JointState state = JointState::Tracked;
};

std::vector<Sighting> sightings_of(const Person& person, std::size_t joint) {
  std::vector<Sighting> all;
  for (const SensorView& view : person.views) {
    const Joint& seen = view.skeleton.joints[joint];
    if (!seen.seen() || !seen.covariance.known()) continue;
    const Eigen::Matrix3d square =
        seen.covariance.matrix() + kMinVariance * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d way = view.eye - seen.position;
    all.push_back({seen.position,
                   Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(square).operatorSqrt(),
                   std::atan2(way.x(), way.z()), seen.state});
  }
  return all;
}

double correlation(JointId id, const Sighting& a, const Sighting& b, const SharedErrors& shared) {
  const bool is_neck = id == JointId::Neck || id == JointId::SpineShoulder;
  const double apart = a.bearing - b.bearing;
  return (is_neck ? shared.neck : shared.joints) *
         (1.0 - shared.twice + shared.twice * std::cos(2.0 * apart));
}

/// The covariance matrix of the errors of all views of one joint together, three rows per view.
Eigen::MatrixXd errors_of(JointId id, const std::vector<Sighting>& all,
                          const SharedErrors& shared) {
  const auto count = static_cast<Eigen::Index>(all.size());
  Eigen::MatrixXd squares(3 * count, 3 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index k = 0; k < count; ++k) {
      const Sighting& a = all[static_cast<std::size_t>(i)];
      const Sighting& b = all[static_cast<std::size_t>(k)];
      const double together = i == k ? 1.0 : correlation(id, a, b, shared);
      squares.block<3, 3>(3 * i, 3 * k) = together * a.root * b.root;
    }
  }
  return squares;
}

/// Estimates one point by generalised least squares.
Joint best_linear(JointId id, const std::vector<Sighting>& all, const SharedErrors& shared) {
  const auto count = static_cast<Eigen::Index>(all.size());
  Eigen::MatrixXd same(3 * count, 3);
  Eigen::VectorXd seen(3 * count);
  Joint joint;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Sighting& each = all[static_cast<std::size_t>(i)];
    same.middleRows<3>(3 * i) = Eigen::Matrix3d::Identity();
    seen.segment<3>(3 * i) = each.place;
    joint.state = std::max(joint.state, each.state);
  }
  const Eigen::LDLT<Eigen::MatrixXd> squares(errors_of(id, all, shared));
  const Eigen::Matrix3d covariance =
      Eigen::Matrix3d(same.transpose() * squares.solve(same)).inverse();
  joint.position = covariance * (same.transpose() * squares.solve(seen));
  joint.covariance = Covariance(covariance);
  return joint;
}

}  // namespace

Body linear_bound(const Person& person, const SharedErrors& shared) {
  Body body;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto id = static_cast<JointId>(j);
    const std::vector<Sighting> all = sightings_of(person, j);
    if (!all.empty()) body.joints[j] = best_linear(id, all, shared);
  }
  return body;
}

Body error_weighted_mean(const Person& person, const Body& exact) {
  Body body;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Joint& joint = body.joints[j];
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0.0;
    for (const SensorView& view : person.views) {
      const Joint& seen = view.skeleton.joints[j];
      if (!seen.seen()) continue;
      const double error = std::max(kMinError, (seen.position - exact.joints[j].position).norm());
      sum += seen.position / (error * error);
      weights += 1.0 / (error * error);
      joint.state = std::max(joint.state, seen.state);
    }
    if (weights > 0) joint.position = sum / weights;
  }
  return body;
}

}  // namespace chorus::bench::baselines
