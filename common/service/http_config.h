// The section "http" of a service's configuration, the same on each of them.
#pragma once

#include "common/base/config_reader.h"
#include "common/http/server.h"

namespace chorus::service {

/// What is absent keeps the value that `out` has: each service brings its own port.
void read_http(ConfigReader config, http::ServerConfig& out);

}  // namespace chorus::service
