#include "fusion-server/mxtp/mxtp_outlet.h"

#include <utility>

#include "fusion-server/mxtp/mxtp_encoder.h"
#include "fusion-server/outlet/datagram_outlet.h"
#include "fusion-server/outlet/datagram_sender.h"

namespace chorus::mxtp {

void read_settings(ConfigReader& reader, Settings& out) {
  outlet::read_targets(reader, out.targets);
}

Result<std::unique_ptr<outlet::Outlet>> open_outlet(const Settings& settings,
                                                    const outlet::OutletContext& /*context*/) {
  const auto all = [](const outlet::TrackerFrame& frame) {
    outlet::Datagrams datagrams;
    for (const outlet::TrackerBody& body : frame.bodies) {
      if (auto bytes = encode(frame, body); !bytes.empty()) datagrams.push_back(std::move(bytes));
    }
    return datagrams;
  };
  return outlet::open_datagram_outlet("mxtp", {{settings.targets, all}});
}

}  // namespace chorus::mxtp
