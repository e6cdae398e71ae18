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
  /// For one person, with an empty memory.
  std::unique_ptr<Estimator> (*begin)(const FusionConfig& config);
};

[[nodiscard]] std::span<const MethodRow> methods();
[[nodiscard]] std::string_view name_of(Method method);
[[nodiscard]] std::optional<Method> method_named(std::string_view name);

/// A method with the configured parameters, for one person.
[[nodiscard]] std::unique_ptr<Estimator> begin(Method method, const FusionConfig& config);

/// The configured method, or for a person of whom there are rays alone the one that uses them.
[[nodiscard]] Method method_for(const Person& person, const FusionConfig& config);

}  // namespace chorus::fusion
