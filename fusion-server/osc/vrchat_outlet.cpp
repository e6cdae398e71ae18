#include "fusion-server/osc/vrchat_outlet.h"

#include <utility>

#include "fusion-server/osc/vrchat_encoder.h"
#include "fusion-server/outlet/datagram_outlet.h"
#include "fusion-server/outlet/datagram_sender.h"

namespace chorus::vrchat {

namespace {

outlet::DatagramStream vrchat_stream_of(const outlet::PersonTargets& person, bool head) {
  const auto slot = static_cast<std::size_t>(person.slot);
  return {person.targets, [slot, head](const outlet::TrackerFrame& frame) {
            const outlet::TrackerBody* body = outlet::in_slot(frame, slot);
            return body ? encode(*body, {head}) : outlet::Datagrams{};
          }};
}

}  // namespace

void read_settings(ConfigReader& reader, Settings& out) {
  outlet::read_targets(reader, out.targets);
  reader.read("slot", out.slot, 0, outlet::kMaxSlots - 1);
  outlet::read_persons(reader, out.persons);
  reader.read("head", out.head);
}

Result<std::unique_ptr<outlet::Outlet>> open_outlet(const Settings& settings,
                                                    const outlet::OutletContext& /*context*/) {
  std::vector<outlet::DatagramStream> streams{
      vrchat_stream_of({settings.slot, settings.targets}, settings.head)};
  for (const outlet::PersonTargets& person : settings.persons)
    streams.push_back(vrchat_stream_of(person, settings.head));
  return outlet::open_datagram_outlet("vrchat", std::move(streams));
}

}  // namespace chorus::vrchat
