// Runs an io_context on the caller's thread, for servers that must survive exceptions.
#pragma once

#include <functional>
#include <string_view>

#include "common/net/asio.h"

namespace chorus::net {

/// Returns when there is no more work.  Handlers catch the exceptions that they expect.  Any other
/// exception (such as out of memory) is logged as the event `failure`; it ends what that handler
/// was doing, but not the program.  `prepare` is called before the first handler and again after
/// each such exception, to start what must always be running.
void run_events(asio::io_context& io, std::string_view failure,
                const std::function<void()>& prepare = {});

}  // namespace chorus::net
