// Decides in which folder a fusion server keeps state across restarts, and checks that folders can
// be used.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/environment.h"
#include "common/base/result.h"

namespace chorus::server {

/// Returns `configured` unless it is "auto".  For "auto", returns the first of $STATE_DIRECTORY
/// (set by systemd), $XDG_STATE_HOME/chorus/fusion-PORT and $HOME/.local/state/chorus/fusion-PORT;
/// empty when none is set, or when the port is 0 (any), which does not distinguish this server from
/// others.
[[nodiscard]] std::string state_folder(std::string_view configured, std::uint16_t port,
                                       const Environment& environment);

/// Creates the folder if necessary and writes a test file; the error says what is wrong.
[[nodiscard]] Result<void> probe_folder(const std::string& folder);

/// Checks that the viewer's files are there, with everything that they need.
[[nodiscard]] Result<void> probe_viewer(const std::string& folder);

}  // namespace chorus::server
