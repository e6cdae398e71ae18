// chorus camera list: lists the webcams of this host.
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/setup/webcams.h"

namespace chorus::ctl {
namespace {

nlohmann::json as_json(const Webcam& camera) {
  nlohmann::json modes = nlohmann::json::array();
  for (const WebcamMode& mode : camera.modes) {
    modes.push_back({{"format", mode.format},
                     {"width", mode.width},
                     {"height", mode.height},
                     {"rateHz", mode.rate_hz}});
  }
  return {{"source", camera.path},
          {"name", camera.name},
          {"bus", camera.bus},
          {"modes", std::move(modes)},
          {"problem", camera.problem}};
}

Result<int> list(bool json) {
  const std::vector<Webcam> found = webcams("/dev");
  if (!json) {
    std::cout << webcam_report(found);
    return kExitOk;
  }
  nlohmann::json all = nlohmann::json::array();
  for (const Webcam& camera : found) all.push_back(as_json(camera));
  std::cout << json_text(all);
  return kExitOk;
}

}  // namespace

Run add_camera(CLI::App& options) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* const listing = options.add_subcommand("list", "Webcams, their formats and sizes");
  listing->add_flag("--json", *json, "Report as JSON");
  options.require_subcommand(1);
  return [json] { return list(*json); };
}

}  // namespace chorus::ctl
