// The tracker outputs over HTTP: /outputs/ says which are open, who listens, and what was refused.
#pragma once

#include <functional>
#include <vector>

#include "common/http/router.h"
#include "common/service/serving.h"
#include "fusion-server/sink.h"

namespace chorus::rest {

/// JSON: {"outputs": {"vrpn": {"state": "open", "clients": 1, ...}}}.
[[nodiscard]] std::string outputs_json(const std::vector<OutputStatus>& outputs);

/// `states` may be called from the server's thread at any time.
void add_output_routes(http::Router& router, const service::Serving& serving,
                       std::function<std::vector<OutputStatus>()> states);

}  // namespace chorus::rest
