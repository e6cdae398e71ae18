// Which changed keys of a configuration wait for a restart.  Nobody lists them: each changed key is
// tried alone.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace chorus::service {

/// True when a service that is to be as this configuration (JSON) says would have to start anew.
using NeedsRestart = std::function<bool(const std::string& text)>;

/// The keys whose values differ between two configurations (JSON) and that need a restart when they
/// alone change: "http.port, outputs".  Lists are compared as a whole.  Empty: none.
[[nodiscard]] std::string waiting_keys(std::string_view running, std::string_view wanted,
                                       const NeedsRestart& needs_restart);

}  // namespace chorus::service
