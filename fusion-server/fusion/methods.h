// The table of methods that the configuration chooses from by name.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"

namespace chorus::fusion {

struct MethodRow {
  Method method;
  std::string_view name;
  /// Creates an estimator for one person, with an empty memory.
  std::unique_ptr<Estimator> (*begin)(const FusionConfig& config);
};

[[nodiscard]] std::span<const MethodRow> methods();
[[nodiscard]] std::string_view name_of(Method method);
[[nodiscard]] std::optional<Method> method_named(std::string_view name);

/// An estimator of this method for one person, with the configured parameters.
[[nodiscard]] std::unique_ptr<Estimator> begin(Method method, const FusionConfig& config);

/// The configured method, but PointsAndRays for a person seen as rays alone.  The body filter
/// corrects the typical errors of depth sensors, so where it is configured, two kinds of people get
/// another method: PointsAndRays if the depth of all points is hardly known according to their
/// covariance; and InverseVariance, which takes a body as it is, if it comes with covariances from
/// a single source, such as another fusion server or a file of fused frames.
[[nodiscard]] Method method_for(const Person& person, const FusionConfig& config);

/// True if the view has rays, or points whose depth is hardly known.
[[nodiscard]] bool is_of_a_camera(const SensorView& view);

}  // namespace chorus::fusion
