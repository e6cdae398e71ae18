// How many files and sockets this process may have open.
#pragma once

#include <cstddef>

namespace chorus {

/// Raises the soft limit to the hard one, at most to 65 536, and returns what is allowed now.
/// Shells and systemd give 1024 by default although the hard limit is far above.
std::size_t raise_descriptor_limit();

}  // namespace chorus
