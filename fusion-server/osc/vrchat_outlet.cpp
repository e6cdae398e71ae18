#include "fusion-server/osc/vrchat_outlet.h"

#include <algorithm>
#include <utility>

#include "fusion-server/outlet/datagram_outlet.h"
#include "fusion-server/outlet/datagram_sender.h"

namespace chorus::vrchat {

namespace {

outlet::DatagramStream vrchat_stream_of(const outlet::PersonTargets& person,
                                        const Settings& settings) {
  const auto slot = static_cast<std::size_t>(person.slot);
  const Content usual{settings.head, settings.prop_trackers};
  return {person.targets, [slot, usual](const outlet::TrackerFrame& frame) {
            const outlet::TrackerBody* body = outlet::in_slot(frame, slot);
            if (!body) return outlet::Datagrams{};
            Content content = usual;
            for (const outlet::TrackerProp& prop : frame.props)
              if (prop.pose.tracked && prop.slot == slot) content.props.push_back(&prop);
            return encode(*body, content);
          }};
}

void read_prop_trackers(ConfigReader& reader, std::vector<PropTracker>& out) {
  constexpr int kLast = 8;
  if (reader.has("prop_trackers")) out.clear();
  for (ConfigReader& item : reader.items("prop_trackers")) {
    PropTracker each;
    item.read("tracker", each.tracker, 1, kLast);
    item.read("prop", each.prop);
    if (each.tracker == 0) item.complain("tracker", "is missing: a number from 1 to 8");
    if (each.prop.empty()) item.complain("prop", "is missing: the name of one of \"props\"");
    if (std::ranges::find(out, each.tracker, &PropTracker::tracker) != out.end())
      item.complain("tracker", "is given to two things");
    out.push_back(std::move(each));
  }
}

}  // namespace

void read_settings(ConfigReader& reader, Settings& out) {
  outlet::read_targets(reader, out.targets);
  reader.read("slot", out.slot, 0, outlet::kMaxSlots - 1);
  outlet::read_persons(reader, out.persons);
  reader.read("head", out.head);
  read_prop_trackers(reader, out.prop_trackers);
}

Result<std::unique_ptr<outlet::Outlet>> open_outlet(const Settings& settings,
                                                    const outlet::OutletContext& context) {
  for (const PropTracker& each : settings.prop_trackers)
    if (std::ranges::find(context.props, each.prop) == context.props.end())
      return fail(ErrorCode::InvalidArgument, "outputs.vrchat.prop_trackers",
                  "there is no prop \"" + each.prop + "\"; the section \"props\" names them");
  std::vector<outlet::DatagramStream> streams{
      vrchat_stream_of({settings.slot, settings.targets}, settings)};
  for (const outlet::PersonTargets& person : settings.persons)
    streams.push_back(vrchat_stream_of(person, settings));
  return outlet::open_datagram_outlet("vrchat", std::move(streams));
}

}  // namespace chorus::vrchat
