#include "fusion-server/publish/vmc/vmc_outlet.h"

#include <optional>

#include "common/base/duration.h"
#include "fusion-server/publish/datagram_outlet.h"
#include "fusion-server/publish/datagram_sender.h"
#include "fusion-server/publish/vmc/vmc_encoder.h"

namespace chorus::publish::vmc {

void read_settings(ConfigReader& reader, Settings& out) {
  read_targets(reader, out.targets);
  reader.read("slot", out.slot, 0, kMostSlots - 1);
  reader.read("trackers", out.trackers);
}

Result<std::unique_ptr<Outlet>> open_outlet(const Settings& settings,
                                            const OutletContext& /*context*/) {
  const auto slot = static_cast<std::size_t>(settings.slot);
  std::optional<Timestamp> first;
  return open_datagram_outlet(
      "vmc", settings.targets,
      [slot, trackers = settings.trackers, first](const TrackerFrame& frame) mutable {
        if (!first) first = frame.instant;
        return encode(in_slot(frame, slot), {seconds(frame.instant - *first), trackers});
      });
}

}  // namespace chorus::publish::vmc
