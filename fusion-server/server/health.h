// What /healthz says of the fusion server.
#pragma once

#include <vector>

#include "common/service/common_resources.h"
#include "fusion-server/sink.h"
#include "fusion-server/status/server_status.h"

namespace chorus::server {

[[nodiscard]] service::Health health_of(const Status& status);

/// Adds the outputs that could not be opened by a reload.
[[nodiscard]] service::Health with_outputs(service::Health health,
                                           const std::vector<OutputStatus>& states);

}  // namespace chorus::server
