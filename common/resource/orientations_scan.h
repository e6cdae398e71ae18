// Internal to common/resource: two readers of /orientations in JSON.
//
// A suit of thirteen sensors at a thousand hertz sends nine megabytes a second, which a parser that
// builds a tree does not read in the tenth of its time that a follower gives to one source.
#pragma once

#include <optional>
#include <string_view>

#include "common/resource/orientations_resource.h"

namespace chorus::resource {

/// Reads the document in one pass, without a tree.  Nothing is refused here: at the first member
/// that it does not know, or a value that is not clearly valid, there is none.  Then
/// parse_orientations() reads the document from the start and reports mistakes.
[[nodiscard]] std::optional<OrientationsResource> scan_orientations(std::string_view json);

/// The reader that knows every form.
[[nodiscard]] Result<OrientationsResource> parse_orientations(std::string_view json);

}  // namespace chorus::resource
