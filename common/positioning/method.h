// The ways to tell where a person in a suit is; all behind one interface, the Tracker.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace chorus::positioning {

enum class Method {
  Suit,         ///< Walking by the suit's steps only; cameras are not looked at.
  Silhouettes,  ///< Madaras et al., to the letter: 25 silhouettes around the last place.
  Outline,      ///< Gauss-Newton on the outline, in a filter with the suit's steps.
  Landmarks,    ///< A network's landmarks, in the same filter.
  Both,         ///< Landmarks and outline in one estimate.
};

[[nodiscard]] std::string_view name_of(Method method);
[[nodiscard]] std::optional<Method> method_named(std::string_view name);
/// All names, the default first.
[[nodiscard]] std::span<const std::string_view> method_names();

[[nodiscard]] constexpr bool uses_landmarks(Method method) {
  return method == Method::Landmarks || method == Method::Both;
}
/// Whether it looks at the pictures themselves.
[[nodiscard]] constexpr bool uses_pictures(Method method) {
  return method == Method::Silhouettes || method == Method::Outline || method == Method::Both;
}

}  // namespace chorus::positioning
