// Keeps the kernel's send queue small, for readers that want the newest data rather than all data.
#pragma once

#include "common/net/asio.h"

namespace chorus::net {

/// Limits the data that the kernel queues, beyond what the reader has room for, to about 4 kB,
/// because queued data can no longer be replaced by something newer.
void keep_queue_small(Socket& socket);

/// True when the kernel's send queue is nearly empty; data of a finished write may still be in it.
/// If false, the socket becomes writable (wait_write) as soon as the queue is nearly empty.
[[nodiscard]] bool is_queue_small(Socket& socket);

}  // namespace chorus::net
