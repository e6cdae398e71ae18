// Reads small documents about one thing (/floor-plane, /clock): its simple properties as strings.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/resource/media_type.h"

namespace chorus::resource {

/// The properties of the only subject of class `type` ("FloorPlane"), by name without prefix. Reads
/// only literals and individuals of our namespace; refuses RDF that gives a property two different
/// values.
using Properties = std::map<std::string, std::string, std::less<>>;
[[nodiscard]] Result<Properties> read_properties(std::string_view bytes, Format format,
                                                 std::string_view type);

/// The value of this key as a finite number.
[[nodiscard]] Result<double> number_of(const Properties& properties, std::string_view key);

}  // namespace chorus::resource
