// The files of the contract in proto/, which are compiled in (proto/CMakeLists.txt).
#pragma once

#include <string_view>

namespace chorus::proto {

[[nodiscard]] std::string_view vocabulary();    ///< proto/vocab/chorus.ttl, served at /ns
[[nodiscard]] std::string_view shapes();        ///< proto/shapes.ttl
[[nodiscard]] std::string_view context();       ///< proto/context.jsonld
[[nodiscard]] std::string_view openapi_json();  ///< proto/openapi.json
[[nodiscard]] std::string_view frame_schema();  ///< proto/frame.schema.json, in recordings

}  // namespace chorus::proto
