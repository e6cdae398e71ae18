// Sends MXTP02 over UDP, one datagram per body and frame.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "common/base/result.h"
#include "fusion-server/outlet/outlet.h"

namespace chorus::mxtp {

struct Settings {
  std::vector<std::string> targets{"127.0.0.1:9763"};

  bool operator==(const Settings&) const = default;
};

void read_settings(ConfigReader& reader, Settings& out);

[[nodiscard]] Result<std::unique_ptr<outlet::Outlet>> open_outlet(
    const Settings& settings, const outlet::OutletContext& context);

}  // namespace chorus::mxtp
