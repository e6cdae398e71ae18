// Sends DTrack's ASCII format over UDP and, if enabled, answers on the command channel.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "common/base/result.h"
#include "fusion-server/dtrack/command_server.h"
#include "fusion-server/dtrack/dtrack_encoder.h"
#include "fusion-server/outlet/datagram_sender.h"
#include "fusion-server/outlet/outlet.h"

namespace chorus::dtrack {

struct Settings {
  std::vector<std::string> targets{"127.0.0.1:5000"};
  /// The port from which we send; clients write to it so that their firewalls let our datagrams in.
  /// 0: any port.
  int source_port = 50107;
  outlet::Multicast multicast;
  Room room = Room::Normal;
  bool human_model = false;
  bool commands = false;
  CommandServerOptions command;
  /// Also sends to the host in control, to the port from which that host wrote to our source port.
  bool send_to_client = false;

  bool operator==(const Settings&) const = default;
};

void read_settings(ConfigReader& reader, Settings& out);

[[nodiscard]] Result<std::unique_ptr<outlet::Outlet>> open_outlet(
    const Settings& settings, const outlet::OutletContext& context);

}  // namespace chorus::dtrack
