// Internal to common/resource: writes a Node as JSON.
#pragma once

#include <string>

#include "common/resource/node.h"

namespace chorus::resource {

/// `linked`: as JSON-LD, with @context and with decimals as strings (docs/decisions/0005).
[[nodiscard]] std::string to_json(const Node& node, bool linked, const Place& place);

}  // namespace chorus::resource
