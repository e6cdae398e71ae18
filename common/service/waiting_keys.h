// Finds the changed configuration keys that need a restart, by trying each changed key alone.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace chorus::service {

/// True when a service would need a restart to run with this configuration (JSON).
using NeedsRestart = std::function<bool(const std::string& text)>;

/// The keys that differ between two configurations (JSON), such as "http.port".  Lists are compared
/// as a whole.
[[nodiscard]] std::vector<std::string> changed_keys(std::string_view running,
                                                    std::string_view wanted);

/// Those of changed_keys() that need a restart when changed alone.
[[nodiscard]] std::vector<std::string> waiting_keys(std::string_view running,
                                                    std::string_view wanted,
                                                    const NeedsRestart& needs_restart);

/// The configuration (JSON), with the values that `other` has at these keys.
[[nodiscard]] std::string with_keys_of(std::string_view text, std::string_view other,
                                       const std::vector<std::string>& keys);

}  // namespace chorus::service
