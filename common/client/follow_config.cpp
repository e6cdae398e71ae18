#include "common/client/follow_config.h"

#include <string>

#include "common/http/client.h"

namespace chorus::client {

void read_timings(ConfigReader reader, PollTimings& out) {
  using std::chrono::milliseconds;
  using std::chrono::seconds;
  reader.read_s("wait_s", out.wait, seconds(1), seconds(30));
  reader.read_ms("answer_slack_ms", out.answer_slack, milliseconds(50), seconds(30));
  reader.read_ms("min_interval_ms", out.min_interval, milliseconds(1), seconds(1));
  reader.read_ms("first_backoff_ms", out.first_backoff, milliseconds(10), seconds(10));
  reader.read_ms("max_backoff_ms", out.max_backoff, milliseconds(100), seconds(600));
  reader.read("stream", out.stream);
  reader.read_s("floor_interval_s", out.floor_interval, seconds(1), seconds(3600));
}

tls::Trust read_trust(ConfigReader poll) {
  std::string file;
  poll.read("ca", file);
  auto trust = tls::Trust::load(file);
  if (trust) return *trust;
  poll.complain("ca", to_string(trust.error()));
  return {};
}

std::optional<FollowedService> read_followed(ConfigReader& entry, const tls::Trust& trust) {
  std::string name;
  FollowedService service;
  entry.read("id", name);
  entry.read("url", service.url);
  entry.read("token", service.token);
  const auto id = SensorId::parse(name);
  if (!id) {
    entry.complain("id", id.error().message);
    return std::nullopt;
  }
  if (auto url = http::parse_url(service.url); !url) {
    entry.complain("url", url.error().message);
    return std::nullopt;
  }
  service.id = *id;
  service.trust = trust;
  return service;
}

}  // namespace chorus::client
