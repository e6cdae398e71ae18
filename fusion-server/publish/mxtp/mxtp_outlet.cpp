#include "fusion-server/publish/mxtp/mxtp_outlet.h"

#include <utility>

#include "fusion-server/publish/datagram_outlet.h"
#include "fusion-server/publish/datagram_sender.h"
#include "fusion-server/publish/mxtp/mxtp_encoder.h"

namespace chorus::publish::mxtp {

void read_settings(ConfigReader& reader, Settings& out) { read_targets(reader, out.targets); }

Result<std::unique_ptr<Outlet>> open_outlet(const Settings& settings,
                                            const OutletContext& /*context*/) {
  return open_datagram_outlet("mxtp", settings.targets, [](const TrackerFrame& frame) {
    std::vector<std::vector<char>> datagrams;
    for (const TrackerBody& body : frame.bodies) {
      if (auto bytes = encode(frame, body); !bytes.empty()) datagrams.push_back(std::move(bytes));
    }
    return datagrams;
  });
}

}  // namespace chorus::publish::mxtp
