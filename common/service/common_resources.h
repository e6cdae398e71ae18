// The resources that every Chorus service has in the same form:
// /clock /healthz /metrics /openapi.json /ns /shapes /context.jsonld /.well-known/void
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/http/router.h"
#include "common/time/clock.h"

namespace chorus::service {

/// Health for a load balancer: 200 when ready, 503 with the reason when not.
struct Health {
  bool ready = true;
  std::string reason;  ///< If not ready: why.  If ready: a human-readable warning, or empty.
};

struct CommonResources {
  std::shared_ptr<const Clock> clock;  ///< Null: the host's clock.
  std::function<Health()> health;      ///< Empty: always ready.
  /// Returns the complete Prometheus text (metrics.h); empty: there is no /metrics.
  std::function<std::string()> metrics;
};

void add_routes(http::Router& router, const CommonResources& options);

}  // namespace chorus::service
