// Runs an io_context on the caller's thread, for servers that must outlive what a handler throws.
#pragma once

#include <functional>
#include <string_view>

#include "common/http/asio.h"

namespace chorus::http {

/// Until there is no more work.  Handlers catch what they can name; whatever else is thrown (no
/// memory) is logged as the event `failure` and costs what the handler was doing, not the program.
/// `prepare` is called before the first handler and again after one has thrown: it starts what must
/// always be under way.
void run_events(net::io_context& io, std::string_view failure,
                const std::function<void()>& prepare = {});

}  // namespace chorus::http
