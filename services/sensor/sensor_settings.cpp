#include "services/sensor/sensor_settings.h"

#include <utility>

#include "common/service/http_config.h"

namespace chorus::sensor_service {
namespace {

constexpr std::string_view kDefaultId = "s1";

void read_id(ConfigReader& root, SensorId& out) {
  std::string text(kDefaultId);
  root.read("id", text);
  if (const auto id = SensorId::parse(text)) {
    out = *id;
  } else {
    root.complain("id", id.error().message);
  }
}

}  // namespace

Result<SensorSettings> read_sensor_settings(ConfigReader root) {
  SensorSettings settings;
  auto& [live, at_start] = settings;
  read_id(root, at_start.id);
  service::read_http(root.child("http"), at_start.http);
  live.tokens = http::all_tokens(std::exchange(at_start.http.bearer_token, {}),
                                 std::exchange(at_start.http.tokens, {}));
  live.identity = std::exchange(at_start.http.identity, {});
  at_start.secure = live.identity.has_value();
  root.read("images", live.images);
  root.read_s("history_s", at_start.history, std::chrono::seconds(1), std::chrono::seconds(120));
  read_clock_errors(root.child("clock"), at_start.clock);
  service::read_log(root.child("log"), live.log);
  service::read_recording(root.child("recording"), at_start.recording);
  read_device(root.child("device"), at_start.id, at_start.device);
  if (auto ok = root.finish(); !ok) return pass(ok);
  return settings;
}

}  // namespace chorus::sensor_service
