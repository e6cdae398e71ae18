// Decides in which folder a fusion server keeps state across restarts and from which it serves the
// viewer, and checks that folders can be used, and by nobody else.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

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

/// Keeps other servers from using the same state folder, because each would overwrite what the
/// other stores.  The claim ends with this object, and with the process however that ends.
class StateClaim {
 public:
  /// Conflict if another server has the folder.  A claim on nothing for "", and where there is no
  /// file to lock, as in a folder that cannot be written to.
  [[nodiscard]] static Result<StateClaim> take(const std::string& folder);
  StateClaim() = default;
  StateClaim(StateClaim&& other) noexcept : lock_(std::exchange(other.lock_, -1)) {}
  StateClaim& operator=(StateClaim&& other) noexcept;
  ~StateClaim();

 private:
  explicit StateClaim(int lock) : lock_(lock) {}

  int lock_ = -1;  ///< Descriptor of a locked file; -1: none.
};

/// Returns `configured` unless it is "auto". For "auto", returns the viewer that was installed with
/// the program or is in its sources (shipped_folder), empty if there is none.
[[nodiscard]] std::string viewer_folder(const std::string& configured);

/// Checks that the viewer's files are there, with everything that they need.  `folder`: what
/// viewer_folder() returned.
[[nodiscard]] Result<void> probe_viewer(const std::string& folder);

}  // namespace chorus::server
