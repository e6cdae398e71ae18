#include "fusion-server/publish/vrchat/vrchat_outlet.h"

#include "fusion-server/publish/datagram_outlet.h"
#include "fusion-server/publish/datagram_sender.h"
#include "fusion-server/publish/vrchat/vrchat_encoder.h"

namespace chorus::publish::vrchat {

void read_settings(ConfigReader& reader, Settings& out) {
  read_targets(reader, out.targets);
  reader.read("slot", out.slot, 0, kMostSlots - 1);
  reader.read("head", out.head);
}

Result<std::unique_ptr<Outlet>> open_outlet(const Settings& settings,
                                            const OutletContext& /*context*/) {
  using Datagrams = std::vector<std::vector<char>>;
  const auto slot = static_cast<std::size_t>(settings.slot);
  return open_datagram_outlet("vrchat", settings.targets,
                              [slot, head = settings.head](const TrackerFrame& frame) {
                                const TrackerBody* body = in_slot(frame, slot);
                                return body ? encode(*body, {head}) : Datagrams{};
                              });
}

}  // namespace chorus::publish::vrchat
