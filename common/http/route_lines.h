// The header lines that all answers of a route share, written once at start.
#pragma once

#include <string>

#include "common/http/route_table.h"
#include "common/http/server.h"

namespace chorus::http {

/// The lines of answers that belong to no route.
[[nodiscard]] std::string common_lines(const ServerConfig& config);

[[nodiscard]] std::string lines_of(const ServerConfig& config, const Router::Entry& entry);

}  // namespace chorus::http
