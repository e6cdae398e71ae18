// `/metrics` of a sensor in Prometheus' text format.
#pragma once

#include <string>

#include "common/http/server.h"
#include "services/sensor/sensor_service.h"

namespace chorus::sensor_service {

[[nodiscard]] std::string metrics_text(const ServiceCounters& service,
                                       const http::ServerCounters& server);

}  // namespace chorus::sensor_service
