// Includes what our clients use of Boost.Beast's HTTP: its response parser.
//
// The server reads requests itself (request_head.h), more strictly than Beast 1.74 does.
#pragma once

#include "common/net/asio.h"

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
