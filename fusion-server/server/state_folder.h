// Decides in which folder a fusion server keeps state across restarts and from which it serves the
// viewer, and checks that folders can be used.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/environment.h"
#include "common/base/result.h"

namespace chorus::server {

/// Returns `configured` unless it is "auto". For "auto", returns $STATE_DIRECTORY (set by systemd)
/// or, if that is not set, $XDG_STATE_HOME/chorus/fusion-PORT or
/// $HOME/.local/state/chorus/fusion-PORT, in this order. Empty if none of them is set. The last two
/// are not used for port 0 (any), which does not distinguish this server from others.
[[nodiscard]] std::string state_folder(std::string_view configured, std::uint16_t port,
                                       const Environment& environment);

/// Creates the folder if necessary and writes a test file; the error says what is wrong.
[[nodiscard]] Result<void> probe_folder(const std::string& folder);

/// Returns `configured` unless it is "auto". For "auto", returns the viewer that was installed with
/// the program or is in its sources (shipped_folder), empty if there is none.
[[nodiscard]] std::string viewer_folder(const std::string& configured);

/// Checks that the viewer's files are there, with everything that they need.  `folder`: what
/// viewer_folder() returned.
[[nodiscard]] Result<void> probe_viewer(const std::string& folder);

}  // namespace chorus::server
