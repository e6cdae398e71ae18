// The parts of a request target, decoded strictly.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace chorus::http {

using Query = std::map<std::string, std::string, std::less<>>;

/// Decodes a path.  Refuses broken escapes, escaped control characters, escaped '/' and '\', and
/// "." or ".." segments, so that a decoded path has one meaning only.  The result points into `raw`
/// or, if something had to be decoded, into `storage`.
[[nodiscard]] Result<std::string_view> decode_path(std::string_view raw, std::string& storage);

/// Decodes "a=1&b=%20" (without '?').  Refuses broken escapes and escaped control characters.  Of a
/// repeated key the last value counts; a key without '='
/// has an empty value.  '+' stands for itself, not for a space, because time zones are written
/// "+01:00".
[[nodiscard]] Result<Query> decode_query(std::string_view raw);

}  // namespace chorus::http
