// Where a fusion server keeps data across restarts, and whether folders can be used at all.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/environment.h"
#include "common/base/result.h"

namespace chorus::server {

/// `configured` unchanged, unless it is "auto": then the first of $STATE_DIRECTORY (systemd's),
/// $XDG_STATE_HOME/chorus/fusion-PORT and $HOME/.local/state/chorus/fusion-PORT; empty when none is
/// set, or there is no port to tell this server from another (0: any).
[[nodiscard]] std::string state_folder(std::string_view configured, std::uint16_t port,
                                       const Environment& environment);

/// Creates the folder if necessary and writes a test file; the error says what is wrong.
[[nodiscard]] Result<void> probe_folder(const std::string& folder);

/// Checks that the viewer's files are there, with all that they need.
[[nodiscard]] Result<void> probe_viewer(const std::string& folder);

}  // namespace chorus::server
