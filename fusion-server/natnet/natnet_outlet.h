// Serves fused bodies as OptiTrack's Motive does: NatNet 3.1, unicast or multicast.
#pragma once

#include <memory>
#include <string>

#include "common/base/config_reader.h"
#include "common/base/result.h"
#include "common/net/allow_list.h"
#include "fusion-server/natnet/natnet_encoder.h"
#include "fusion-server/outlet/outlet.h"

namespace chorus::natnet {

enum class Transmission { Unicast, Multicast };

struct Settings {
  std::string address = "127.0.0.1";
  int command_port = 1510;  ///< 0: any free port.
  net::AllowList allow = {};
  Transmission transmission = Transmission::Unicast;
  std::string group = "239.255.42.99";
  int data_port = 1511;  ///< Port of the multicast group.
  int multicast_hops = 1;
  int max_clients = 16;
  int max_clients_per_address = 4;
  Duration client_timeout = std::chrono::seconds(10);
  Models models;

  bool operator==(const Settings&) const = default;
};

void read_settings(ConfigReader& reader, Settings& out);

/// Opens the server; all slots are described to clients.
[[nodiscard]] Result<std::unique_ptr<outlet::Outlet>> open_outlet(
    const Settings& settings, const outlet::OutletContext& context);

}  // namespace chorus::natnet
