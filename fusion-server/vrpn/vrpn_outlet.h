// VRPN 07.xx server over UDP and TCP: trackers Body0, Body1, ..., and one per joint unless that is
// switched off.
#pragma once

#include <memory>
#include <string>

#include "common/base/config_reader.h"
#include "common/base/result.h"
#include "common/net/allow_list.h"
#include "fusion-server/outlet/outlet.h"

namespace chorus::vrpn {

struct Settings {
  std::string address = "127.0.0.1";
  int port = 3883;  ///< 0: any free port.
  net::AllowList allow = {};
  bool joint_trackers = true;
  int max_clients = 128;
  int max_clients_per_address = 64;

  bool operator==(const Settings&) const = default;
};

void read_settings(ConfigReader& reader, Settings& out);

/// Opens the server; all slots are announced to clients.
[[nodiscard]] Result<std::unique_ptr<outlet::Outlet>> open_outlet(
    const Settings& settings, const outlet::OutletContext& context);

}  // namespace chorus::vrpn
