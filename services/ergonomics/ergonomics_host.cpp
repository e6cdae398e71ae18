#include "services/ergonomics/ergonomics_host.h"

#include <array>
#include <cstdio>
#include <random>
#include <utility>

#include "common/base/file.h"
#include "common/resource/link_lines.h"
#include "common/service/http_config.h"

namespace chorus::ergonomics_service {
namespace {

constexpr std::uintmax_t kMaxRulesBytes = 1'000'000;

/// Six hexadecimal digits, new at every start.
std::string new_run() {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "%06x", std::random_device{}() & 0xFFFFFFu);
  return text.data();
}

service::Serving serving_of(const StartSettings& at_start) {
  return {new_run(), service::root_of(at_start.http, at_start.secure, at_start.http.port)};
}

http::ServerConfig server_config(const ErgonomicsSettings& settings) {
  http::ServerConfig config = settings.at_start.http;
  config.tokens = settings.live.tokens;
  config.identity = settings.live.identity;
  config.policy = resource::answer_policy();
  return config;
}

client::FollowOptions follow_options(const StartSettings& at_start) {
  client::FollowOptions options;
  options.timings = at_start.poll;
  return options;
}

}  // namespace

Result<std::unique_ptr<ErgonomicsHost>> ErgonomicsHost::make(const ErgonomicsSettings& settings) {
  auto methods = ergonomics::find_methods(settings.at_start.methods);
  if (!methods) return pass(methods);
  auto rules = ergonomics::shipped_rules();
  if (!settings.at_start.rules.empty()) {
    const auto text = read_file(settings.at_start.rules, kMaxRulesBytes);
    if (!text) return pass(text);
    const auto own = ergonomics::read_rules(*text, settings.at_start.rules);
    if (!own) return pass(own);
    rules.insert(rules.end(), own->begin(), own->end());
  }
  std::optional<workplace::Scene> scene;
  if (!settings.at_start.scene.empty()) {
    const auto text = read_file(settings.at_start.scene, kMaxRulesBytes);
    if (!text) return pass(text);
    auto read = workplace::read_scene(*text, settings.at_start.scene);
    if (!read) return pass(read);
    scene = std::move(*read);
  }
  return std::make_unique<ErgonomicsHost>(settings, Scoring(std::move(*methods), std::move(rules)),
                                          std::move(scene));
}

ErgonomicsHost::ErgonomicsHost(const ErgonomicsSettings& settings, Scoring scoring,
                               std::optional<workplace::Scene> scene)
    : settings_(settings),
      service_(std::move(scoring), serving_of(settings.at_start), std::move(scene)),
      followers_(follow_options(settings.at_start)),
      server_(server_config(settings), routes()) {}

ErgonomicsHost::~ErgonomicsHost() { stop(); }

service::Health ErgonomicsHost::health() const {
  if (service_.scored_any()) return {};
  std::string reason = "no frame has come from the tracker yet";
  for (const client::FollowReport& each : followers_.reports()) {
    if (!each.last_error.empty()) reason = each.last_error;
  }
  return {false, reason};
}

std::shared_ptr<http::Router> ErgonomicsHost::routes() {
  auto router = std::make_shared<http::Router>();
  service_.add_routes(*router);
  service::CommonResources options;
  options.health = [this] { return health(); };
  options.self = [this] { return service_.description(); };
  service::add_routes(*router, options);
  return router;
}

Result<void> ErgonomicsHost::start() {
  if (auto ok = server_.start(); !ok) return ok;
  followers_.follow<resource::FrameResource>(
      client::kFrames, {settings_.at_start.tracker},
      [this](const client::Arrived<resource::FrameResource>& arrived) {
        service_.take(*arrived.document);
      });
  log::info("ergonomics serving",
            {{"url",
              service::root_of(settings_.at_start.http, settings_.at_start.secure, server_.port())},
             {"tracker", settings_.at_start.tracker.url}});
  return {};
}

void ErgonomicsHost::stop() {
  followers_.stop();
  server_.stop();
}

void ErgonomicsHost::take(const LiveSettings& live) {
  settings_.live = live;
  server_.set_tokens(live.tokens);
  if (live.identity) server_.set_identity(*live.identity);
}

service::About about_ergonomics() {
  return {"chorus-ergonomics",
          "chorus-ergonomics: posture scores of the people of a tracker, with their doubt.\n"
          "Without options: scores http://127.0.0.1:8080/ on http://127.0.0.1:8093/.",
          "  chorus-ergonomics --config deploy/config/ergonomics.json\n"
          "  chorus-ergonomics --tracker http://tracker.local:8080/\n"
          "  curl http://127.0.0.1:8093/ergonomics/\n",
          {{"--tracker", "tracker.url", "The tracker whose people are scored (tracker.url)"},
           {"--methods", "methods", "Methods, by commas (methods)"},
           {"--scene", "scene", "Points, boxes and obstacles of the workplace (scene)"}},
          "/etc/chorus/ergonomics.json the configuration that the service of the package reads\n"
          "/usr/share/doc/chorus-ergonomics/examples/ergonomics.json every key with its default\n"};
}

}  // namespace chorus::ergonomics_service
