#include "common/positioning/method.h"

#include <algorithm>
#include <array>

namespace chorus::positioning {
namespace {

constexpr std::array kMethods{Method::Both, Method::Landmarks, Method::Outline, Method::Silhouettes,
                              Method::Suit};
constexpr std::array<std::string_view, kMethods.size()> kMethodNames{"both", "landmarks", "outline",
                                                                     "silhouettes", "suit"};

}  // namespace

std::string_view name_of(Method method) {
  const auto found = std::find(kMethods.begin(), kMethods.end(), method);
  return found == kMethods.end()
             ? ""
             : kMethodNames.at(static_cast<std::size_t>(found - kMethods.begin()));
}

std::optional<Method> method_named(std::string_view name) {
  const auto found = std::find(kMethodNames.begin(), kMethodNames.end(), name);
  if (found == kMethodNames.end()) return std::nullopt;
  return kMethods.at(static_cast<std::size_t>(found - kMethodNames.begin()));
}

std::span<const std::string_view> method_names() { return kMethodNames; }

}  // namespace chorus::positioning
