#include "fusion-server/rest/output_resources.h"

#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/fnv.h"
#include "common/resource/link_lines.h"

namespace chorus::rest {

std::string outputs_json(const std::vector<OutputStatus>& outputs) {
  nlohmann::json all = nlohmann::json::object();
  for (const OutputStatus& output : outputs) {
    const SinkCounters& counters = output.counters;
    nlohmann::json one{{"state", output.error.empty() ? "open" : "failed"},
                       {"clients", counters.clients},
                       {"frames", counters.frames},
                       {"dropped", counters.dropped},
                       {"failed", counters.failed},
                       {"refused", counters.refused}};
    if (!output.error.empty()) one["lastError"] = output.error;
    if (!counters.last_refusal.empty()) one["lastRefusal"] = counters.last_refusal;
    if (!counters.last_failure.empty()) one["lastFailure"] = counters.last_failure;
    all[output.name] = std::move(one);
  }
  return nlohmann::json{{"outputs", std::move(all)}}.dump(
             1, ' ', false, nlohmann::json::error_handler_t::replace) +
         "\n";
}

void add_output_routes(http::Router& router, const service::Serving& serving,
                       std::function<std::vector<OutputStatus>()> states) {
  router.get("/outputs/",
             [run = serving.run, states = std::move(states)](
                 const http::Request&, const http::PathParams&) -> Result<http::DocumentPtr> {
               std::string json = outputs_json(states());
               http::DocumentOptions options;
               options.version = run + "-" + std::to_string(fnv1a(json));
               return resource::other_document("application/json", std::move(json),
                                               std::move(options));
             });
}

}  // namespace chorus::rest
