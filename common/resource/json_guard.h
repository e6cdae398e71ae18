// JSON from the network: bounded in size and nesting, without repeated keys, never throwing.
#pragma once

#include <cstddef>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "common/base/result.h"

namespace chorus::resource {

struct JsonLimits {
  std::size_t bytes = 2'000'000;
  int nesting = 32;
};

/// The parsed document; errors name the byte, as the parser does.
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text,
                                                const JsonLimits& limits = {});

}  // namespace chorus::resource
