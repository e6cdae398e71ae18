// How many files and sockets this process may have open.
#pragma once

#include <cstddef>

namespace chorus {

/// Raises the soft limit to the hard one, but to 65 536 at most, and returns the limit now in
/// force. Shells and systemd give 1024 by default although the hard limit is far above.
std::size_t raise_descriptor_limit();

}  // namespace chorus
