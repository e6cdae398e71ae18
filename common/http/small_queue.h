// For sockets whose readers want the newest rather than everything.
#pragma once

#include "common/http/asio.h"

namespace chorus::http {

/// Lets the kernel take little more than what the reader has room for: what waits in it for a slow
/// reader cannot be replaced by something newer any more.
void keep_queue_small(Socket& socket);

/// True when next to nothing waits in the kernel.  A write may be over before: it adds to what
/// waits anyhow.  When it is false, the socket becomes writable (wait_write) as soon as it would be
/// true.
[[nodiscard]] bool is_queue_small(Socket& socket);

}  // namespace chorus::http
