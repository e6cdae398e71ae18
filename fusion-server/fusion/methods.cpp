#include "fusion-server/fusion/methods.h"

#include <algorithm>
#include <array>

#include "fusion-server/fusion/body_filter.h"
#include "fusion-server/fusion/joint_view.h"
#include "fusion-server/fusion/joint_wise.h"
#include "fusion-server/fusion/otto_kalman.h"
#include "fusion-server/fusion/points_and_rays.h"
#include "fusion-server/fusion/selection.h"

namespace chorus::fusion {
namespace {

constexpr std::array kMethods{
    MethodRow{Method::InverseVariance, "inverse-variance", joint_wise},
    MethodRow{Method::Otto, "otto", joint_wise},
    MethodRow{Method::Mean, "mean", joint_wise},
    MethodRow{Method::BestView, "best-view", joint_wise},
    MethodRow{Method::BestSkeleton, "best-skeleton", best_skeleton},
    MethodRow{Method::JointCounting, "joint-counting", joint_counting},
    MethodRow{Method::Substitution, "substitution", substitution},
    MethodRow{Method::OttoKalman, "otto-kalman", otto_kalman},
    MethodRow{Method::PointsAndRays, "points-and-rays", points_and_rays},
    MethodRow{Method::BodyFilter, "body-filter", body_filter},
};

/// True if only one view shows the person, and it states the covariance of all its points: such a
/// body was already fused by somebody else.  Its covariance includes slow errors, which a second
/// filter would take for noise, and no other view could correct it.
bool fused_already(const Person& person) {
  if (person.views.size() != 1) return false;
  return std::ranges::all_of(person.views.front().skeleton.joints, [](const Joint& joint) {
    return !joint.given() || (joint.seen() && joint.covariance.known());
  });
}

}  // namespace

std::span<const MethodRow> methods() { return kMethods; }

std::string_view name_of(Method method) {
  const auto* const row = std::ranges::find(kMethods, method, &MethodRow::method);
  return row == kMethods.end() ? "unknown" : row->name;
}

std::optional<Method> method_named(std::string_view name) {
  const auto* const row = std::ranges::find(kMethods, name, &MethodRow::name);
  if (row == kMethods.end()) return std::nullopt;
  return row->method;
}

std::unique_ptr<Estimator> begin(Method method, const FusionConfig& config) {
  const auto* const row = std::ranges::find(kMethods, method, &MethodRow::method);
  return (row == kMethods.end() ? kMethods.front() : *row).begin(config);
}

Method method_for(const Person& person, const FusionConfig& config) {
  const auto any = [&](auto wanted) {
    return std::ranges::any_of(person.views, [&](const SensorView& view) {
      return std::ranges::any_of(view.skeleton.joints, wanted);
    });
  };
  if (!any(&Joint::seen)) return any(&Joint::bears) ? Method::PointsAndRays : config.method;
  if (config.method != Method::BodyFilter) return config.method;
  const bool depth = any([](const Joint& joint) { return joint.seen() && !nearly_a_ray(joint); });
  if (!depth) return Method::PointsAndRays;
  return fused_already(person) ? Method::InverseVariance : config.method;
}

bool is_of_a_camera(const SensorView& view) {
  return std::ranges::any_of(view.skeleton.joints, [](const Joint& joint) {
    return joint.bears() || (joint.seen() && nearly_a_ray(joint));
  });
}

}  // namespace chorus::fusion
