#include "services/ergonomics/ergonomics_settings.h"

#include <utility>

#include "common/client/follow_config.h"
#include "common/ergonomics/method.h"
#include "common/http/client.h"
#include "common/service/http_config.h"

namespace chorus::ergonomics_service {
namespace {

void read_tracker(ConfigReader& root, StartSettings& out) {
  ConfigReader poll = root.child("poll");
  client::read_timings(poll, out.poll);
  const tls::Trust trust = client::read_trust(poll);
  out.tracker.id = SensorId::parse("tracker").value();
  out.tracker.url = "http://127.0.0.1:8080/";
  out.tracker.trust = trust;
  ConfigReader tracker = root.child("tracker");
  tracker.read("url", out.tracker.url);
  tracker.read("token", out.tracker.token);
  if (auto url = http::parse_url(out.tracker.url); !url)
    tracker.complain("url", url.error().message);
}

}  // namespace

Result<ErgonomicsSettings> read_ergonomics_settings(ConfigReader root) {
  ErgonomicsSettings settings;
  auto& [live, at_start] = settings;
  service::read_http(root.child("http"), at_start.http);
  live.tokens = http::all_tokens(std::exchange(at_start.http.bearer_token, {}),
                                 std::exchange(at_start.http.tokens, {}));
  live.identity = std::exchange(at_start.http.identity, {});
  at_start.secure = live.identity.has_value();
  service::read_log(root.child("log"), live.log);
  read_tracker(root, at_start);
  root.read("methods", at_start.methods);
  if (const auto known = ergonomics::find_methods(at_start.methods); !known)
    root.complain("methods", to_string(known.error()));
  root.read("scene", at_start.scene);
  root.read("rules", at_start.rules);
  if (auto ok = root.finish(); !ok) return pass(ok);
  return settings;
}

}  // namespace chorus::ergonomics_service
