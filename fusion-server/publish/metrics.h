// /metrics of a fusion server, Prometheus text.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/http/server.h"
#include "fusion-server/publish/sink.h"
#include "fusion-server/publish/status.h"

namespace chorus::publish {

[[nodiscard]] std::string metrics_text(const Status& status,
                                       const std::vector<std::unique_ptr<Sink>>& outputs,
                                       const http::ServerCounters& http);

}  // namespace chorus::publish
