#include "fusion-server/fusion/joint_view.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "common/sensor/limits.h"
#include "fusion-server/fusion/weight.h"

namespace chorus::fusion {
namespace {

constexpr double kAxes = 3.0;

std::uint64_t bit_of(const SensorId& sensor, const std::vector<SensorId>& sensors) {
  const auto at = std::find(sensors.begin(), sensors.end(), sensor);
  const auto index = static_cast<std::size_t>(at - sensors.begin());
  return at == sensors.end() || index >= kMaxSensors ? 0 : std::uint64_t{1} << index;
}

JointView joint_view_of(const SensorView& view, JointId joint, const std::vector<SensorId>& sensors,
                        const ErrorModel& errors) {
  JointView found;
  found.joint = view.skeleton[joint];
  found.weight = Weight::clamped(view.weight).value();
  found.covariance = errors.covariance(view, joint);
  found.contributor = bit_of(view.sensor, sensors);
  found.eye = view.eye;
  return found;
}

}  // namespace

std::vector<JointView> joint_views_of(JointId joint, const Person& person,
                                      const std::vector<SensorId>& sensors,
                                      const ErrorModel& errors) {
  std::vector<JointView> views;
  for (std::size_t i = 0; i < person.views.size(); ++i) {
    if (!person.views[i].skeleton[joint].seen()) continue;
    views.push_back(joint_view_of(person.views[i], joint, sensors, errors));
    views.back().view = i;
  }
  return views;
}

std::vector<JointView> points_and_rays_of(JointId joint, const Person& person,
                                          const std::vector<SensorId>& sensors,
                                          const ErrorModel& errors) {
  std::vector<JointView> views;
  for (std::size_t i = 0; i < person.views.size(); ++i) {
    const SensorView& view = person.views[i];
    const bool usable = view.skeleton[joint].seen() || view.eye.allFinite();
    if (!usable || !view.skeleton[joint].given()) continue;
    views.push_back(joint_view_of(view, joint, sensors, errors));
    views.back().view = i;
  }
  return views;
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
