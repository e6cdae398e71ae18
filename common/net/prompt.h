// Connections whose small messages have to arrive soon.
#pragma once

#include "common/net/asio.h"

namespace chorus::net {

/// Makes the socket send at once (TCP_NODELAY) and repeat a lost packet after 60 ms instead of 200
/// ms, without doubling that time as long as few packets are under way, because in an event stream
/// a lost packet delays all frames behind it.  On connections with longer round trips the kernel
/// still lengthens the time.  Options that the kernel does not know are ignored: before Linux
/// 6.15 it keeps the 200 ms.
void make_prompt(Socket& socket);

}  // namespace chorus::net
