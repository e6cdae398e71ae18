#include "common/service/common_resources.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/fnv.h"
#include "common/base/log_queue.h"
#include "common/base/version.h"
#include "common/resource/clock_resource.h"
#include "common/resource/link_lines.h"
#include "common/resource/node.h"
#include "common/resource/place.h"
#include "common/service/metrics.h"
#include "common/service/thing_description.h"
#include "common/time/ntp_status.h"
#include "proto/embedded.h"

namespace chorus::service {
namespace {

using http::DocumentOptions;
using http::DocumentPtr;
using http::PathParams;
using http::Request;
using http::Variant;
using resource::Kind;
using resource::linked;

/// An ETag for content that changes only with a new build.
std::string version_of(std::string_view text) { return std::to_string(fnv1a(text)); }

/// One document with the same content for each of these media types.
DocumentPtr fixed_document(std::vector<std::string> media_types, std::string_view text) {
  DocumentOptions options;
  options.version = version_of(text);
  options.cache_control = "public, max-age=3600";
  std::vector<Variant> variants;
  for (std::string& type : media_types)
    variants.push_back({std::move(type), [text] { return std::string(text); }});
  return std::make_shared<const http::Document>(linked(std::move(variants), Kind::Other),
                                                std::move(options));
}

void serve(http::Router& router, std::string path, DocumentPtr document) {
  router.get(std::move(path),
             [document = std::move(document)](
                 const Request&, const PathParams&) -> Result<DocumentPtr> { return document; });
}

DocumentOptions fleeting(Timestamp now) {
  DocumentOptions options;
  options.version = std::to_string(to_unix_ns(now));
  options.cache_control = "no-store";
  return options;
}

DocumentPtr clock_document(const Clock& clock) {
  const resource::ClockState state{clock.now(), read_ntp_status()};
  return resource::document_of(resource::clock_node(state), fleeting(state.now), {"clock"});
}

Result<DocumentPtr> health_document(const Health& health, Timestamp now) {
  if (!health.ready) return fail(ErrorCode::Unavailable, "health", health.reason);
  DocumentOptions options = fleeting(now);
  nlohmann::json status{{"status", health.reason.empty() ? "ok" : "degraded"}};
  if (!health.reason.empty()) status["warning"] = health.reason;
  const std::string json =
      status.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  const std::string text = health.reason.empty() ? "ok\n" : "degraded: " + health.reason + "\n";
  std::vector<Variant> variants{{"application/json", [json] { return json; }},
                                {"text/plain", [text] { return text; }}};
  return std::make_shared<const http::Document>(linked(std::move(variants), Kind::Other),
                                                std::move(options));
}

/// The service's own health, and whether it runs with the configuration that it was given.
Health with_configuration(Health health,
                          const std::shared_ptr<const Configuration>& configuration) {
  const std::string trouble = configuration == nullptr ? "" : configuration->trouble();
  if (trouble.empty() || !health.ready) return health;
  health.reason += (health.reason.empty() ? "" : "; ") + trouble;
  return health;
}

/// Metrics of the process, as opposed to those of the service.
std::string process_metrics(const std::shared_ptr<const Configuration>& configuration) {
  MetricsText text;
  text.gauge({"chorus_build", "1, with the version of the program."}, 1,
             {{"version", std::string(version())}});
  text.counter({"chorus_log_dropped_lines_total", "Log lines dropped because nobody read them."},
               static_cast<double>(log::dropped_lines()));
  if (configuration == nullptr) return text.text();
  const ConfigurationFacts facts = configuration->facts();
  text.gauge({"chorus_configuration_reload_failed",
              "1 while the last reload changed nothing because of a mistake; see /configuration."},
             facts.reload_error.empty() ? 0.0 : 1.0);
  text.gauge({"chorus_configuration_pending_keys", "Changed keys that wait for a restart."},
             static_cast<double>(facts.waiting.size()));
  return text.text();
}

DocumentPtr metrics_document(std::string text, Timestamp now) {
  DocumentOptions options = fleeting(now);
  return resource::other_document("text/plain; version=0.0.4; charset=utf-8", std::move(text),
                                  std::move(options));
}

/// VoID: the entry points of the data, and its vocabularies.
DocumentPtr void_document() {
  const resource::Place place{".well-known/void"};
  resource::Node node{"", {"void:Dataset"}, {}};
  node.properties = {
      {"title", std::string("Chorus: live bodies as linked data")},
      {"rootResource", resource::Ref{"../"}},
      {"exampleResource", resource::Ref{"../frame"}},
      {"vocabulary", std::vector<resource::Ref>{{"https://w3id.org/chorus-tracking/ns#"},
                                                {"http://www.w3.org/ns/ldp#"}}}};
  DocumentOptions options;
  options.version = "1";
  options.cache_control = "public, max-age=3600";
  return resource::document_of(std::move(node), std::move(options), place);
}

DocumentPtr thing_document(const Self& self, const http::Router& router, const ThingFacts& facts) {
  const auto text = std::make_shared<const std::string>(thing_description(self, router, facts));
  DocumentOptions options;
  options.version = version_of(*text);
  std::vector<Variant> variants;
  for (const char* type : {"application/td+json", "application/json"})
    variants.push_back({type, [text] { return *text; }});
  return std::make_shared<const http::Document>(linked(std::move(variants), Kind::Other),
                                                std::move(options));
}

/// The descriptions for the Web of Things, as each client needs one: with the address by which it
/// asks.  Making one takes a while, so it is made once; the last few are kept, because anybody may
/// ask by any numeric address.
class Things {
 public:
  Things(const http::Router& router, std::function<Self()> self)
      : router_(router), self_(std::move(self)) {}

  [[nodiscard]] DocumentPtr of(const Request& request) {
    const ThingFacts facts{request.root, request.guards_reading, request.guards_writing};
    const Self self = self_();
    const std::scoped_lock lock(mutex_);
    const auto kept = std::ranges::find_if(
        made_, [&](const Made& one) { return one.facts == facts && same_thing(one.self, self); });
    if (kept != made_.end()) return kept->document;
    if (made_.size() >= kMost) made_.pop_front();
    made_.push_back({facts, self, thing_document(self, router_, facts)});
    return made_.back().document;
  }

 private:
  /// True if all is the same that a Thing Description says.
  static bool same_thing(const Self& a, const Self& b) {
    return a.title == b.title && a.description == b.description && a.type == b.type &&
           a.resources == b.resources;
  }

  static constexpr std::size_t kMost = 8;
  struct Made {
    ThingFacts facts;
    Self self;
    DocumentPtr document;
  };

  const http::Router& router_;
  std::function<Self()> self_;
  std::mutex mutex_;
  std::deque<Made> made_;
};

void add_fixed(http::Router& router) {
  serve(router, "/openapi.json",
        fixed_document({"application/json", "application/vnd.oai.openapi+json"},
                       proto::openapi_json()));
  serve(router, "/ns", fixed_document({"text/turtle"}, proto::vocabulary()));
  serve(router, "/shapes", fixed_document({"text/turtle"}, proto::shapes()));
  serve(router, "/context.jsonld",
        fixed_document({"application/ld+json", "application/json"}, proto::context()));
  serve(router, "/.well-known/void", void_document());
}

/// What a service says of itself where it has it: figures, and the configuration in force.
void add_own_state(http::Router& router, const CommonResources& options,
                   const std::shared_ptr<const Clock>& clock) {
  if (options.metrics) {
    router.vital("/metrics");
    router.get("/metrics",
               [clock, metrics = options.metrics, configuration = options.configuration](
                   const Request&, const PathParams&) -> Result<DocumentPtr> {
                 return metrics_document(
                     metrics() + process_metrics(configuration ? configuration() : nullptr),
                     clock->now());
               });
  }
  if (options.configuration) {
    router.get("/configuration",
               [clock, configuration = options.configuration](
                   const Request&, const PathParams&) -> Result<DocumentPtr> {
                 return resource::other_document("application/json",
                                                 configuration_json(configuration()->facts()),
                                                 fleeting(clock->now()));
               });
  }
}

}  // namespace

void add_routes(http::Router& router, const CommonResources& options) {
  std::shared_ptr<const Clock> clock = options.clock;
  if (!clock) clock = std::make_shared<SystemClock>();
  router.get("/clock", [clock](const Request&, const PathParams&) -> Result<DocumentPtr> {
    return clock_document(*clock);
  });
  router.get("/healthz",
             [clock, health = options.health, configuration = options.configuration](
                 const Request&, const PathParams&) -> Result<DocumentPtr> {
               return health_document(with_configuration(health ? health() : Health{},
                                                         configuration ? configuration() : nullptr),
                                      clock->now());
             });
  router.vital("/healthz");
  router.for_everybody("/healthz");
  add_own_state(router, options, clock);
  add_fixed(router);
  if (!options.self) return;
  router.get("/.well-known/wot",
             [things = std::make_shared<Things>(router, options.self)](
                 const Request& request, const PathParams&) -> Result<DocumentPtr> {
               return things->of(request);
             });
}

}  // namespace chorus::service
