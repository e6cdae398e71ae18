// Publishes people to an MQTT broker (3.1.1, libmosquitto), for plants that have one.
//
// PREFIX/people/ID is published for every frame and person, quality 0, not retained; PREFIX/status
// says "online", or, as the last will that the broker keeps, "offline".  A broker that is gone or
// slow costs frames, which are counted; it is connected to again by itself.
#pragma once

#include <memory>
#include <string>

#include "common/base/config_reader.h"
#include "common/base/result.h"
#include "fusion-server/outlet/outlet.h"

namespace chorus::mqtt {

struct Settings {
  std::string server = "127.0.0.1";
  int port = 1883;
  std::string user;  ///< Empty: without a password.
  std::string password;
  std::string ca_file;                ///< PEM, for TLS; empty: no TLS.
  std::string topic = "chorus/cell";  ///< chorus/SITE/CELL
  double max_rate = 30.0;             ///< Frames a second at most; more are left out.

  bool operator==(const Settings&) const = default;
};

void read_settings(ConfigReader& reader, Settings& out);

/// Does not wait for the broker.  Io: the file of the authority cannot be read.
[[nodiscard]] Result<std::unique_ptr<outlet::Outlet>> open_outlet(
    const Settings& settings, const outlet::OutletContext& context);

}  // namespace chorus::mqtt
