// Finds the changed configuration keys that need a restart, by trying each changed key alone.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace chorus::service {

/// True when a service would need a restart to run with this configuration (JSON).
using NeedsRestart = std::function<bool(const std::string& text)>;

/// The keys that differ between two configurations (JSON) and need a restart when changed alone,
/// such as "http.port, outputs"; "" if there are none.  Lists are compared as a whole.
[[nodiscard]] std::string waiting_keys(std::string_view running, std::string_view wanted,
                                       const NeedsRestart& needs_restart);

}  // namespace chorus::service
