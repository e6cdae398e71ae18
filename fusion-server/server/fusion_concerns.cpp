#include "fusion-server/server/fusion_concerns.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/http/client.h"
#include "fusion-server/server/initial_registration.h"
#include "fusion-server/server/state_folder.h"

namespace chorus::server {
namespace {

bool configured(const LiveSettings& live, const SensorId& sensor) {
  return std::ranges::find(live.sensors, sensor, &client::FollowedService::id) !=
         live.sensors.end();
}

struct OwnPort {
  std::string key;
  int port = 0;  ///< 0: any free port.
  bool tcp = false;
  bool udp = false;
};

/// The ports that the server itself would bind.
std::vector<OwnPort> own_ports(const FusionSettings& config) {
  std::vector<OwnPort> ports{{"http.port", config.at_start.http.port, true, false}};
  const outputs::OutputsConfig& out = config.live.outputs;
  if (out.vrpn.common.enabled)
    ports.push_back({"outputs.vrpn.port", out.vrpn.protocol.port, true, true});
  if (out.dtrack.common.enabled) {
    const auto& dtrack = out.dtrack.protocol;
    ports.push_back({"outputs.dtrack.source_port", dtrack.source_port, false, true});
    if (dtrack.commands)
      ports.push_back({"outputs.dtrack.command.port", dtrack.command.port, true, false});
  }
  if (out.natnet.common.enabled)
    ports.push_back({"outputs.natnet.command_port", out.natnet.protocol.command_port, false, true});
  return ports;
}

void compare_ports(const FusionSettings& config, service::Concerns& all) {
  const std::vector<OwnPort> ports = own_ports(config);
  for (std::size_t i = 0; i < ports.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const bool alike = (ports[i].tcp && ports[j].tcp) || (ports[i].udp && ports[j].udp);
      if (!alike || ports[i].port == 0 || ports[i].port != ports[j].port) continue;
      all.push_back(ports[i].key + ": is the port of " + ports[j].key + " too; give it another");
    }
  }
}

void look_for_own_url(const FusionSettings& settings, service::Concerns& all) {
  const http::ServerConfig& own = settings.at_start.http;
  for (const client::FollowedService& sensor : settings.live.sensors) {
    const auto url = http::parse_url(sensor.url);
    if (!url || own.port == 0 || url->port != own.port) continue;
    const bool here = url->host == "localhost" || url->host.starts_with("127.") ||
                      url->host == "::1" || url->host == own.address;
    if (here) {
      all.push_back("sensors: the url of " + sensor.id.str() +
                    " is that of this server itself; name the sensor's address, or set another "
                    "http.port");
    }
  }
}

void add_unless(const Result<void>& probe, const std::string& what, service::Concerns& all) {
  if (!probe) all.push_back(what + to_string(probe.error()));
}

void look_at_files(const FusionSettings& settings, const std::string& state,
                   service::Concerns& all) {
  const std::string& file = settings.at_start.registration_file;
  if (file.empty()) {
    const auto stored = RegistrationStore(state).load();
    if (!stored)
      all.push_back("the stored registration cannot be read: " + to_string(stored.error()));
    return;
  }
  const auto given = given_registration(file);
  if (!given) {
    all.push_back(to_string(given.error()));
  } else if (std::ranges::none_of(given->sensors, [&](const auto& entry) {
               return configured(settings.live, entry.first);
             })) {
    all.push_back("registration.file: " + file + " places none of the configured sensors");
  }
}

}  // namespace

service::Concerns setting_concerns(const FusionSettings& settings) {
  service::Concerns all;
  const LiveSettings& live = settings.live;
  compare_ports(settings, all);
  if (live.sensors.empty()) return all;  // told by host_concerns; what is named cannot be compared
  const auto look_for = [&](const std::string& key, const SensorId& sensor) {
    if (!configured(live, sensor))
      all.push_back(key + ": \"" + sensor.str() + "\" is none of the sensors");
  };
  if (live.registration.master) look_for("registration.master", *live.registration.master);
  for (const registration::KnownDistance& known : live.registration.known_distances) {
    look_for("registration.known_distances", known.first);
    look_for("registration.known_distances", known.second);
  }
  look_for_own_url(settings, all);
  return all;
}

service::Concerns host_concerns(const FusionSettings& settings) {
  const StartSettings& config = settings.at_start;
  service::Concerns all = service::common_concerns(config.http, config.recording);
  const std::string state = state_folder(config.state_dir, config.http.port, own_environment());
  if (!state.empty())
    add_unless(service::usable_folder(state), "where the sensors stand cannot be kept: ", all);
  if (!config.viewer_dir.empty()) {
    add_unless(probe_viewer(viewer_folder(config.viewer_dir)),
               "the viewer cannot be served: ", all);
  }
  look_at_files(settings, state, all);
  if (settings.live.sensors.empty())
    all.emplace_back(
        "no sensor is named in the section \"sensors\": chorus init sensor prints what to write "
        "there, with the option for chorus init fusion");
  return all;
}

}  // namespace chorus::server
