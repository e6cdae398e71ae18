// For sockets whose readers want the newest rather than everything.
#pragma once

#include "common/net/asio.h"

namespace chorus::net {

/// Lets the kernel buffer little more than the reader has room for: what the kernel has queued for
/// a slow reader can no longer be replaced by something newer.
void keep_queue_small(Socket& socket);

/// True when the kernel has next to nothing queued.  A finished write may still be queued there.
/// When false, the socket becomes writable (wait_write) as soon as this would be true.
[[nodiscard]] bool is_queue_small(Socket& socket);

}  // namespace chorus::net
