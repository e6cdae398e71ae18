#include "fusion-server/osc/vmc_outlet.h"

#include <optional>

#include "common/base/duration.h"
#include "fusion-server/osc/vmc_encoder.h"
#include "fusion-server/outlet/datagram_outlet.h"
#include "fusion-server/outlet/datagram_sender.h"

namespace chorus::vmc {

void read_settings(ConfigReader& reader, Settings& out) {
  outlet::read_targets(reader, out.targets);
  reader.read("slot", out.slot, 0, outlet::kMostSlots - 1);
  reader.read("trackers", out.trackers);
}

Result<std::unique_ptr<outlet::Outlet>> open_outlet(const Settings& settings,
                                                    const outlet::OutletContext& /*context*/) {
  const auto slot = static_cast<std::size_t>(settings.slot);
  std::optional<Timestamp> first;
  return outlet::open_datagram_outlet(
      "vmc", settings.targets,
      [slot, trackers = settings.trackers, first](const outlet::TrackerFrame& frame) mutable {
        if (!first) first = frame.instant;
        return encode(outlet::in_slot(frame, slot), {seconds(frame.instant - *first), trackers});
      });
}

}  // namespace chorus::vmc
