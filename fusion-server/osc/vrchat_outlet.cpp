#include "fusion-server/osc/vrchat_outlet.h"

#include "fusion-server/osc/vrchat_encoder.h"
#include "fusion-server/outlet/datagram_outlet.h"
#include "fusion-server/outlet/datagram_sender.h"

namespace chorus::vrchat {

void read_settings(ConfigReader& reader, Settings& out) {
  outlet::read_targets(reader, out.targets);
  reader.read("slot", out.slot, 0, outlet::kMostSlots - 1);
  reader.read("head", out.head);
}

Result<std::unique_ptr<outlet::Outlet>> open_outlet(const Settings& settings,
                                                    const outlet::OutletContext& /*context*/) {
  using Datagrams = std::vector<std::vector<char>>;
  const auto slot = static_cast<std::size_t>(settings.slot);
  return outlet::open_datagram_outlet(
      "vrchat", settings.targets, [slot, head = settings.head](const outlet::TrackerFrame& frame) {
        const outlet::TrackerBody* body = outlet::in_slot(frame, slot);
        return body ? encode(*body, {head}) : Datagrams{};
      });
}

}  // namespace chorus::vrchat
