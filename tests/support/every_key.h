// Changes every key of a configuration, one at a time, so that no list of keys is needed.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace chorus::testing {

/// One key, and the configuration in which only this key has another valid value.
struct ChangedKey {
  std::string key;   ///< "http.port"
  std::string text;  ///< JSON; empty when no other value was accepted.
};

/// `text`: JSON with comments; a list counts as one key.  `accepted` says whether a configuration
/// can be read.
[[nodiscard]] std::vector<ChangedKey> every_key_changed(
    std::string_view text, const std::function<bool(const std::string& text)>& accepted);

}  // namespace chorus::testing
