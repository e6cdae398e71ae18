// The environment of this process as a value, so that tests can supply their own.
#pragma once

#include <cstdlib>
#include <functional>
#include <string>

namespace chorus {

/// The value of an environment variable; null when it is not set.
using Environment = std::function<const char*(const char* name)>;

/// The environment of this process.
[[nodiscard]] inline Environment own_environment() {
  return [](const char* name) -> const char* { return std::getenv(name); };
}

/// Empty when the variable is not set.
[[nodiscard]] inline std::string value_of(const Environment& environment, const char* name) {
  const char* value = environment(name);
  return value == nullptr ? std::string() : std::string(value);
}

}  // namespace chorus
