// Parses JSON from outside the program: size and nesting are limited, repeated keys are refused,
// and no exception is thrown.
#pragma once

#include <cstddef>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "common/base/result.h"

namespace chorus {

struct JsonLimits {
  std::size_t bytes = 2'000'000;
  int nesting = 32;
  bool comments = false;  ///< Whether // and /* */ are allowed, as in configurations.
};

/// The parsed document.  TooLarge if the text exceeds the limits.  Malformed when it is not JSON
/// (the message says where), or when an object has a key twice (the context is that key).
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text,
                                                const JsonLimits& limits = {});

}  // namespace chorus
