// Every key of a configuration, changed one at a time: nobody has to keep a list of them.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace chorus::testing {

/// One key and a text of the configuration in which it alone has another value that is accepted.
struct ChangedKey {
  std::string key;   ///< "http.port"
  std::string text;  ///< JSON; empty when no other value was accepted.
};

/// `text`: JSON with comments; lists count as one key.  `accepted` says whether a configuration can
/// be read.
[[nodiscard]] std::vector<ChangedKey> every_key_changed(
    std::string_view text, const std::function<bool(const std::string& text)>& accepted);

}  // namespace chorus::testing
