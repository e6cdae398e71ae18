#include "fusion-server/fusion/joint_view.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "common/sensor/limits.h"
#include "fusion-server/fusion/weight.h"

namespace chorus::fusion {
namespace {

constexpr double kAxes = 3.0;

JointView joint_view_of(const SensorView& view, JointId joint, std::uint64_t contributor,
                        const ErrorModel& errors) {
  JointView found;
  found.joint = view.skeleton[joint];
  found.weight = Weight::clamped(view.weight).value();
  const JointError error = errors.error(view, joint);
  found.covariance = error.covariance;
  found.whole = error.whole;
  found.contributor = contributor;
  found.eye = view.eye;
  return found;
}

}  // namespace

std::uint64_t contributor_of(const SensorId& sensor, const std::vector<SensorId>& sensors) {
  const auto at = std::find(sensors.begin(), sensors.end(), sensor);
  const auto index = static_cast<std::size_t>(at - sensors.begin());
  return at == sensors.end() || index >= kMaxSensors ? 0 : std::uint64_t{1} << index;
}

std::vector<JointView> joint_views_of(JointId joint, const Person& person,
                                      const std::vector<SensorId>& sensors,
                                      const ErrorModel& errors) {
  std::vector<JointView> views;
  for (std::size_t i = 0; i < person.views.size(); ++i) {
    const SensorView& view = person.views[i];
    if (!view.skeleton[joint].seen()) continue;
    views.push_back(joint_view_of(view, joint, contributor_of(view.sensor, sensors), errors));
    views.back().view = i;
  }
  return views;
}

std::optional<JointView> point_or_ray_of(const SensorView& view, JointId joint,
                                         std::uint64_t contributor, const ErrorModel& errors) {
  const bool usable = view.skeleton[joint].seen() || view.eye.allFinite();
  if (!usable || !view.skeleton[joint].given()) return std::nullopt;
  return joint_view_of(view, joint, contributor, errors);
}

std::vector<JointView> points_and_rays_of(JointId joint, const Person& person,
                                          const std::vector<SensorId>& sensors,
                                          const ErrorModel& errors) {
  std::vector<JointView> views;
  for (std::size_t i = 0; i < person.views.size(); ++i) {
    const SensorView& view = person.views[i];
    auto found = point_or_ray_of(view, joint, contributor_of(view.sensor, sensors), errors);
    if (!found) continue;
    views.push_back(*std::move(found));
    views.back().view = i;
  }
  return views;
}

double pull_of(const Eigen::Matrix3d& information, const Eigen::Matrix3d& spread) {
  return information.cwiseProduct(spread).sum() / kAxes;  // both are symmetric
}

bool nearly_a_ray(const Joint& joint) {
  constexpr double kElongated = 3.0;  // ratio of the standard deviations along and across
  if (!joint.covariance.known()) return false;
  const Eigen::Matrix3d covariance = joint.covariance.matrix();
  const double sigma = largest_sigma(covariance);
  const double along = sigma * sigma;
  return along > kElongated * kElongated * (covariance.trace() - along) / 2.0;
}

double mean_variance(const Eigen::Matrix3d& covariance) { return covariance.trace() / kAxes; }

double largest_sigma(const Eigen::Matrix3d& covariance) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

void state_covariance(FusedJoint& fused, const Eigen::Matrix3d& covariance) {
  fused.variance = mean_variance(covariance);
  fused.joint.covariance = Covariance(covariance);
}

}  // namespace chorus::fusion
