// Connections whose small messages have to arrive soon.
#pragma once

#include "common/net/asio.h"

namespace chorus::net {

/// Sends at once (TCP_NODELAY), and repeats a lost packet after 60 ms instead of 200, without
/// doubling the time for as long as few packets are under way: an event stream that waits for a
/// repetition holds up every frame behind it.  Longer round trips lengthen the time as always. What
/// the kernel does not know (before Linux 6.15 the 60 ms) stays as it is.
void make_prompt(Socket& socket);

}  // namespace chorus::net
