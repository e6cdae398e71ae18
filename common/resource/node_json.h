// Internal to the room: a Node as JSON text.
#pragma once

#include <string>

#include "common/resource/node.h"

namespace chorus::resource {

/// `linked`: JSON-LD, with @context and with decimals as strings (docs/decisions/0005).
[[nodiscard]] std::string to_json(const Node& node, bool linked, const Place& place);

}  // namespace chorus::resource
