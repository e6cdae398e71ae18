// For sockets whose readers want the newest data rather than all of it.
#pragma once

#include "common/net/asio.h"

namespace chorus::net {

/// Limits the kernel's buffer to little more than the reader has room for: what the kernel has
/// queued for a slow reader can no longer be replaced by something newer.
void keep_queue_small(Socket& socket);

/// True when the kernel's queue is nearly empty; a write that has finished may still be in it. If
/// false, the socket becomes writable (wait_write) as soon as it is nearly empty.
[[nodiscard]] bool is_queue_small(Socket& socket);

}  // namespace chorus::net
