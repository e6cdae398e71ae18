// The resources that every Chorus service has in the same form:
// /clock /healthz /metrics /configuration /openapi.json /ns /shapes /context.jsonld
// /.well-known/void
// /.well-known/wot
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/http/router.h"
#include "common/service/configuration.h"
#include "common/service/self_description.h"
#include "common/time/clock.h"

namespace chorus::service {

/// Health for a load balancer: 200 when ready, 503 with the reason when not.
struct Health {
  bool ready = true;
  std::string reason;  ///< If not ready: why.  If ready: what is amiss all the same, or empty.
};

struct CommonResources {
  std::shared_ptr<const Clock> clock;  ///< Null: the host's clock.
  std::function<Health()> health;      ///< Empty: always ready.
  /// Returns the complete Prometheus text (metrics.h); empty: there is no /metrics.
  std::function<std::string()> metrics;
  /// What the service is and has at present; empty: there is no /.well-known/wot.
  std::function<Self()> self;
  /// What is in force, never null; empty: there is no /configuration.
  std::function<std::shared_ptr<const Configuration>()> configuration = {};
};

/// Call it when all other routes have been added.  The router must stay where it is, because its
/// Thing Description tells what it answers.
void add_routes(http::Router& router, const CommonResources& options);

}  // namespace chorus::service
