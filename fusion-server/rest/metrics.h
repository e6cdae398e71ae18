// /metrics of a fusion server, as Prometheus text.
#pragma once

#include <string>
#include <vector>

#include "common/http/server.h"
#include "common/service/metrics.h"
#include "fusion-server/sink.h"
#include "fusion-server/status/server_status.h"

namespace chorus::rest {

[[nodiscard]] std::string metrics_text(const Status& status,
                                       const std::vector<OutputStatus>& outputs,
                                       const http::ServerCounters& http);

}  // namespace chorus::rest
