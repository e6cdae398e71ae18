#include "fusion-server/outlet/person_targets.h"

#include "fusion-server/outlet/datagram_sender.h"
#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::outlet {
namespace {

void read_one(ConfigReader& reader, PersonTargets& out) {
  reader.read("slot", out.slot, 0, kMaxSlots - 1);
  read_targets(reader, out.targets);
}

}  // namespace

void read_persons(ConfigReader& reader, std::vector<PersonTargets>& out) {
  if (reader.has("persons")) out.clear();
  for (ConfigReader& item : reader.items("persons")) {
    PersonTargets person;
    read_one(item, person);
    if (person.targets.empty()) item.complain("targets", "must name at least one HOST:PORT");
    if (out.size() == kMaxSlots) return reader.complain("persons", "has too many entries");
    out.push_back(std::move(person));
  }
}

}  // namespace chorus::outlet
