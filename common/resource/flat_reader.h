// Reads small documents about one thing (/floor-plane, /clock): its simple properties as text.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/resource/media_type.h"

namespace chorus::resource {

/// The properties of the one subject of class `type` ("FloorPlane"), by name without prefix.  Reads
/// only literals and our own individuals; refuses a repeated property.
using Properties = std::map<std::string, std::string, std::less<>>;
[[nodiscard]] Result<Properties> read_properties(std::string_view bytes, Format format,
                                                 std::string_view type);

/// The finite number with this key.
[[nodiscard]] Result<double> number_of(const Properties& properties, std::string_view key);

}  // namespace chorus::resource
