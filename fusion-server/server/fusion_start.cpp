#include "fusion-server/server/fusion_start.h"

#include <utility>

#include "common/base/log.h"
#include "fusion-server/server/fusion_server.h"

namespace chorus::server {

core::CoreConfig core_config(const FusionSettings& settings) {
  const LiveSettings& live = settings.live;
  core::CoreConfig core;
  core.output = live.output;
  core.pipeline = live.pipeline;
  core.pipeline.seating.front = outputs::slots_of_all(settings.live.outputs);
  core.registration = live.registration;
  core.session = live.session;
  core.watch = live.watch;
  core.worn = live.worn;
  for (const client::FollowedService& source : live.inertial) core.inertial.insert(source.id);
  if (!settings.at_start.registration_file.empty()) core.session.automatic = false;
  for (const client::FollowedService& sensor : live.sensors) core.sensors.insert(sensor.id);
  return core;
}

std::vector<SensorId> ids_of(const std::vector<client::FollowedService>& sensors) {
  std::vector<SensorId> ids;
  for (const client::FollowedService& sensor : sensors) ids.push_back(sensor.id);
  return ids;
}

std::uint64_t first_person(const RegistrationStore& store) {
  const auto next = store.load_next_person();
  if (next) return *next;
  log::error("ids of people begin anew", {{"reason", to_string(next.error())}});
  return 1;
}

rest::RegistrationControl registration_control(std::function<void(Command)> ask) {
  rest::RegistrationControl control;
  control.start = [ask](const rest::SessionRequest& request, std::uint64_t session,
                        std::uint64_t ticket) {
    ask(StartSession{request.target, request.adoption, session, ticket});
  };
  control.cancel = [ask](std::uint64_t session, std::uint64_t ticket) {
    ask(CancelSession{session, ticket});
  };
  control.forget = [ask](std::uint64_t ticket) { ask(Forget{ticket}); };
  control.move_origin = [ask](const core::Origin& origin, std::uint64_t ticket) {
    ask(MoveOrigin{origin, ticket});
  };
  control.register_anew = [ask](const SensorId& sensor, std::uint64_t ticket) {
    ask(RegisterAnew{sensor, ticket});
  };
  control.undo = [ask](std::uint64_t ticket) { ask(Undo{ticket}); };
  control.decide = [ask](bool accept, std::uint64_t ticket) { ask(Decide{accept, ticket}); };
  return control;
}

service::About about_fusion() {
  return {
      "chorus-fusion",
      "chorus-fusion: polls body-tracking sensors, registers and fuses them, and answers as one "
      "tracker.",
      "  chorus-fusion --config deploy/config/fusion.json\n"
      "  chorus-fusion --config deploy/config/fusion.json --set outputs.vrpn.enabled=true\n",
      {},
      "/etc/chorus/fusion.json the configuration that the service of the package reads\n"
      "/var/lib/chorus where the sensors stand, and recordings\n"
      "/usr/share/chorus/viewer the files of the viewer\n"
      "/usr/share/doc/chorus-fusion/examples/fusion.json every key with its default\n"};
}

}  // namespace chorus::server
