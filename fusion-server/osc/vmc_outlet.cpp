#include "fusion-server/osc/vmc_outlet.h"

#include <optional>
#include <utility>

#include "common/base/duration.h"
#include "fusion-server/osc/vmc_encoder.h"
#include "fusion-server/outlet/datagram_outlet.h"
#include "fusion-server/outlet/datagram_sender.h"

namespace chorus::vmc {

namespace {

outlet::DatagramStream vmc_stream_of(const outlet::PersonTargets& person, bool trackers) {
  const auto slot = static_cast<std::size_t>(person.slot);
  std::optional<Timestamp> first;
  return {person.targets,
          [slot, trackers, first](const outlet::TrackerFrame& frame) mutable {
            if (!first) first = frame.instant;
            Content content{seconds(frame.instant - *first), trackers, {}};
            for (const outlet::TrackerProp& prop : frame.props)
              if (prop.pose.tracked && prop.slot == slot) content.props.push_back(&prop);
            return encode(outlet::in_slot(frame, slot), content);
          },
          encode_end()};
}

}  // namespace

void read_settings(ConfigReader& reader, Settings& out) {
  outlet::read_targets(reader, out.targets);
  reader.read("slot", out.slot, 0, outlet::kMaxSlots - 1);
  outlet::read_persons(reader, out.persons);
  reader.read("trackers", out.trackers);
}

Result<std::unique_ptr<outlet::Outlet>> open_outlet(const Settings& settings,
                                                    const outlet::OutletContext& /*context*/) {
  std::vector<outlet::DatagramStream> streams{
      vmc_stream_of({settings.slot, settings.targets}, settings.trackers)};
  for (const outlet::PersonTargets& person : settings.persons)
    streams.push_back(vmc_stream_of(person, settings.trackers));
  return outlet::open_datagram_outlet("vmc", std::move(streams));
}

}  // namespace chorus::vmc
