#include "fusion-server/server/sensor_changes.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/config_reader.h"
#include "common/client/follow_config.h"
#include "common/sensor/limits.h"

namespace chorus::server {
namespace {

bool has_id(const Services& services, const SensorId& id) {
  return std::ranges::any_of(services, [&](const auto& each) { return each.id == id; });
}

bool has_url(const Services& services, const std::string& url) {
  return std::ranges::any_of(services, [&](const auto& each) { return each.url == url; });
}

Error nobody(const SensorId& id) {
  return {ErrorCode::NotFound, "sensors/" + id.str(), "no sensor of this id is known here"};
}

}  // namespace

Result<SensorChanges> read_sensor_changes(const std::string& text) {
  auto parsed = ConfigReader::parse(text, "sensors.json");
  if (!parsed) return pass(parsed);
  ConfigReader& root = *parsed;
  SensorChanges changes;
  for (ConfigReader& entry : root.items("sensors")) {
    auto sensor = client::read_followed(entry, {});
    if (sensor && has_id(changes.added, sensor->id))
      entry.complain("id", "is the id of another sensor too");
    else if (sensor)
      changes.added.push_back(std::move(*sensor));
  }
  std::vector<std::string> silenced;
  root.read("silenced", silenced);
  for (const std::string& name : silenced) {
    if (const auto id = SensorId::parse(name))
      changes.silenced.insert(*id);
    else
      root.complain("silenced", id.error().message);
  }
  if (auto ok = root.finish(); !ok) return pass(ok);
  return changes;
}

std::string text_of(const SensorChanges& changes, Tokens tokens) {
  nlohmann::ordered_json sensors = nlohmann::ordered_json::array();
  for (const client::FollowedService& sensor : changes.added) {
    nlohmann::ordered_json one{{"id", sensor.id.str()}, {"url", sensor.url}};
    if (!sensor.token.empty())
      one["token"] = tokens == Tokens::Written ? sensor.token : std::string("(hidden)");
    sensors.push_back(std::move(one));
  }
  nlohmann::ordered_json out{{"sensors", std::move(sensors)}};
  if (!changes.silenced.empty()) {
    out["silenced"] = nlohmann::ordered_json::array();
    for (const SensorId& id : changes.silenced) out["silenced"].push_back(id.str());
  }
  return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<SensorChanges> with_sensors(SensorChanges changes, const Services& configured,
                                   const Services& more) {
  for (const client::FollowedService& sensor : more) {
    const std::string& id = sensor.id.str();
    if (has_id(configured, sensor.id) || has_id(changes.added, sensor.id))
      return fail(ErrorCode::Conflict, "sensors/" + id,
                  "there is a sensor " + id + " already: choose another id");
    if (has_url(configured, sensor.url) || has_url(changes.added, sensor.url))
      return fail(ErrorCode::Conflict, sensor.url, "a sensor of this address is followed already");
    changes.added.push_back(sensor);
  }
  if (configured.size() + changes.added.size() > kMaxSensors)
    return fail(ErrorCode::TooLarge, "sensors",
                "at most " + std::to_string(kMaxSensors) + " are possible");
  return changes;
}

Result<SensorChanges> without_sensor(SensorChanges changes, const Services& configured,
                                     const SensorId& id) {
  if (has_id(configured, id))
    return fail(ErrorCode::Conflict, "sensors/" + id.str(),
                "it stands in the server's configuration: take it out there and reload, or silence "
                "it here");
  if (std::erase_if(changes.added, [&](const auto& each) { return each.id == id; }) == 0)
    return tl::unexpected<Error>(nobody(id));
  changes.silenced.erase(id);
  return changes;
}

Result<SensorChanges> with_silence(SensorChanges changes, const Services& configured,
                                   const SensorId& id, bool silent) {
  if (!has_id(configured, id) && !has_id(changes.added, id))
    return tl::unexpected<Error>(nobody(id));
  if (silent)
    changes.silenced.insert(id);
  else
    changes.silenced.erase(id);
  return changes;
}

Services followed_of(const Services& configured, const SensorChanges& changes) {
  Services all = configured;
  for (const client::FollowedService& sensor : changes.added) {
    if (!has_id(configured, sensor.id) && all.size() < kMaxSensors) all.push_back(sensor);
  }
  std::erase_if(all, [&](const auto& each) { return changes.silenced.contains(each.id); });
  return all;
}

}  // namespace chorus::server
