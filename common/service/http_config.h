// The section "http" of a configuration, the same for every service.
#pragma once

#include "common/base/config_reader.h"
#include "common/http/server.h"

namespace chorus::service {

/// An absent key keeps the value that `out` has: each service has its own default port.
void read_http(ConfigReader config, http::ServerConfig& out);

}  // namespace chorus::service
