// chorus discover: sensors that announce themselves in the local network.
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/client/discovery.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"

namespace chorus::ctl {
namespace {

using client::FoundSensor;

Result<int> discover(bool json) {
  const auto found = client::discovered_sensors();
  if (!found) return pass(found);
  if (json) {
    nlohmann::json all = nlohmann::json::array();
    for (const FoundSensor& sensor : *found)
      all.push_back({{"id", sensor.id},
                     {"url", sensor.url()},
                     {"host", sensor.host},
                     {"address", sensor.address},
                     {"port", sensor.port},
                     {"tls", sensor.tls}});
    std::cout << json_text(all);
  } else if (!found->empty()) {
    std::vector<std::vector<std::string>> rows{{"sensor", "url", "host", "address"}};
    for (const FoundSensor& sensor : *found)
      rows.push_back({sensor.id, sensor.url(), sensor.host, sensor.address});
    std::cout << table(std::move(rows));
  }
  if (found->empty())
    std::cerr << "no sensor announces itself in this network.  Sensor hosts need avahi-daemon when "
                 "chorus init sensor runs; routers and many wireless networks stop multicast.\n";
  return found->empty() ? kExitFailed : kExitOk;
}

}  // namespace

Run add_discover(CLI::App& options) {
  const auto json = std::make_shared<bool>(false);
  options.add_flag("--json", *json, "Report as JSON");
  return [json] { return discover(*json); };
}

}  // namespace chorus::ctl
