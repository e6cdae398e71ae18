#include "services/evaluation/evaluation_settings.h"

#include <set>
#include <utility>

#include "common/client/follow_config.h"
#include "common/evaluation/limb_error.h"
#include "common/http/client.h"
#include "common/service/http_config.h"

namespace chorus::evaluation_service {
namespace {

void read_tracker(ConfigReader reader, const tls::Trust& trust, LiveSettings& out) {
  client::FollowedService tracker;
  tracker.url = "http://127.0.0.1:8080/";
  reader.read("url", tracker.url);
  reader.read("token", tracker.token);
  tracker.id = SensorId::parse("tracker").value();
  tracker.trust = trust;
  if (auto url = http::parse_url(tracker.url); !url) reader.complain("url", url.error().message);
  out.trackers.push_back(std::move(tracker));
}

/// "limbs": ["7=ShankLeft", ...] of one source.
std::map<std::string, inertial::Limb> read_limbs(ConfigReader& source) {
  std::vector<std::string> texts;
  source.read("limbs", texts);
  std::map<std::string, inertial::Limb> out;
  for (const std::string& text : texts) {
    const std::size_t at = text.rfind('=');
    const auto limb =
        at == std::string::npos ? std::nullopt : inertial::limb_meant_by(text.substr(at + 1));
    if (limb)
      out[text.substr(0, at)] = *limb;
    else
      source.complain("limbs", "\"" + text + "\" is not SENSOR=LIMB with a limb such as ShankLeft");
  }
  return out;
}

void read_sources(ConfigReader& root, const tls::Trust& trust, EvaluationSettings& out) {
  std::set<SensorId> known;
  for (ConfigReader& reader : root.items("inertial")) {
    auto limbs = read_limbs(reader);
    auto source = client::read_followed(reader, trust);
    if (!source) continue;
    if (!known.insert(source->id).second)
      reader.complain("id", "is the id of another inertial source too");
    if (!limbs.empty()) out.at_start.limbs[source->id] = std::move(limbs);
    out.live.inertial.push_back(std::move(*source));
  }
}

}  // namespace

Result<EvaluationSettings> read_evaluation_settings(ConfigReader root) {
  EvaluationSettings settings;
  auto& [live, at_start] = settings;
  at_start.tau = evaluation::kPaperTau;
  root.read("title", at_start.title);
  service::read_http(root.child("http"), at_start.http);
  live.tokens = http::all_tokens(std::exchange(at_start.http.bearer_token, {}),
                                 std::exchange(at_start.http.tokens, {}));
  live.identity = std::exchange(at_start.http.identity, {});
  at_start.secure = live.identity.has_value();
  service::read_log(root.child("log"), live.log);
  client::read_timings(root.child("poll"), at_start.poll);
  const tls::Trust trust = client::read_trust(root.child("poll"));
  read_tracker(root.child("tracker"), trust, live);
  read_sources(root, trust, settings);
  root.read("calibration", at_start.calibration);
  root.read_deg("threshold_deg", at_start.tau, 5.0, 180.0);
  root.read("own_thresholds", at_start.own_tau);
  root.read("stated", at_start.stated);
  if (auto ok = root.finish(); !ok) return pass(ok);
  return settings;
}

}  // namespace chorus::evaluation_service
