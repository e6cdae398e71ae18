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

void count_on(core::CoreConfig& config, Timestamp now, const RegistrationStore& store) {
  // No output is faster than 1 kHz, so that no cache takes an old frame; no session is shorter than
  // a second, so that no client follows an old one.
  config.first_sequence = static_cast<std::uint64_t>(to_unix_ns(now) / 1'000'000);
  config.first_session = static_cast<std::uint64_t>(to_unix_ns(now) / 1'000'000'000);
  const auto next = store.load_next_person();
  config.first_person = next ? *next : 1;
  if (!next) log::error("ids of people begin anew", {{"reason", to_string(next.error())}});
}

service::RecordingViewsOptions views_options(service::Recordings& recordings,
                                             const service::RecordingConfig& config,
                                             const std::string& run) {
  service::RecordingViewsOptions options;
  options.files_of = [&recordings](const std::string& name) { return recordings.files_of(name); };
  options.folder = config.folder;
  options.mark_running = [&recordings](auto& name, auto& text) {
    return recordings.mark(name, text);
  };
  options.min_free_bytes = config.limits.min_free_bytes;
  options.made = [&recordings](const record::RecordingReport& made) { recordings.adopt(made); };
  options.run = run;
  return options;
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
