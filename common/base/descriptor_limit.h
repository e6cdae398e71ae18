// How many files and sockets this process may have open.
#pragma once

#include <cstddef>

namespace chorus {

/// Raises the soft limit to the hard limit, but not beyond 65 536, and returns the limit then in
/// force (65 536 if it was higher already).  Shells and systemd set a soft limit of 1024 by
/// default, although the hard limit is far above.
std::size_t raise_descriptor_limit();

}  // namespace chorus
