// /metrics of a fusion server, Prometheus text.
#pragma once

#include <string>

#include "common/http/server.h"
#include "fusion-server/publish/status.h"

namespace chorus::publish {

[[nodiscard]] std::string metrics_text(const Status& status, const http::ServerCounters& http);

}  // namespace chorus::publish
