// Where a fusion server keeps what must survive a restart, and whether folders can be used at all.
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

/// Creates the folder if necessary and writes a file into it; the error says what is wrong with it.
[[nodiscard]] Result<void> probe_folder(const std::string& folder);

/// Whether the viewer's files are there, with everything they need.
[[nodiscard]] Result<void> probe_viewer(const std::string& folder);

}  // namespace chorus::server
