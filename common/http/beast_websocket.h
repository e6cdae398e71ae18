// The only file that includes Boost.Beast's WebSocket stream.
#pragma once

#include "common/http/asio.h"

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <boost/beast/websocket/stream_base.hpp>
