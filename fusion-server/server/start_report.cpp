#include "fusion-server/server/start_report.h"

#include <utility>

#include "common/base/log.h"
#include "fusion-server/server/state_folder.h"

namespace chorus::server {

std::string probe_folders(const StartSettings& config, const std::string& state_folder) {
  const auto told = [](const char* what, const Result<void>& probe) {
    if (!probe) log::error(what, {{"reason", to_string(probe.error())}});
    return probe ? std::string() : to_string(probe.error());
  };
  if (!config.viewer_dir.empty())
    told("viewer cannot be served", probe_viewer(viewer_folder(config.viewer_dir)));
  if (!config.recording.folder.empty())
    told("nothing can be recorded", probe_folder(config.recording.folder));
  if (state_folder.empty()) {
    log::warn(
        config.state_dir.empty()
            ? "state_dir is empty: registration and ids of people are forgotten at the end"
            : "state_dir is \"auto\", but HOME and XDG_STATE_HOME are not set, or http.port is "
              "0: registration and ids of people are forgotten at the end");
    return {};
  }
  const std::string trouble = told("state cannot be kept", probe_folder(state_folder));
  if (trouble.empty()) log::info("state is kept", {{"folder", state_folder}});
  return trouble;
}

service::RecordingsOptions recordings_options(const StartSettings& config,
                                              const service::Serving& serving,
                                              std::shared_ptr<const Clock> clock) {
  service::RecordingsOptions options;
  options.config = config.recording;
  options.head.metadata["title"] = config.title;
  options.has_fused = true;
  options.serving = serving;
  options.clock = std::move(clock);
  return options;
}

void report_start(const FusionSettings& settings, std::uint16_t port) {
  log::info("fusion server ready", {{"address", settings.at_start.http.address},
                                    {"port", port},
                                    {"sensors", settings.live.sensors.size()}});
  if (settings.live.sensors.empty())
    log::warn("no sensor is polled",
              {{"advice",
                "add them on the page /viewer/, or name them in the "
                "section \"sensors\" of a file and start with --config FILE"}});
}

}  // namespace chorus::server
