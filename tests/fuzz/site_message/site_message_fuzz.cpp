// Reads any bytes as what another cell says: each message is read or refused, and what was read is
// finite and can be written and read again.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fusion-server/nats/cell_records.h"
#include "fusion-server/nats/people_message.h"
#include "tests/fuzz/frame_checks.h"

namespace {

using namespace chorus;
using fuzz::require;

void check_people(const site::CellPeople& people) {
  require(people.people.size() <= nats::kMostPeople);
  for (const site::Person& person : people.people) {
    require(person.place.allFinite() && person.velocity.allFinite());
    require(person.covariance.allFinite());
    for (const auto& joint : person.joints) require(!joint || joint->allFinite());
  }
  require(nats::read_people(nats::write_people(people)).has_value());
}

void check_place(const site::CellPlace& place) {
  require(place.site_from_cell.matrix().allFinite());
  require(place.covariance.allFinite());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  if (const auto people = nats::read_people(text)) check_people(*people);
  if (const auto card = nats::read_card(text)) {
    if (card->place) check_place(*card->place);
  }
  if (const auto places = nats::read_places(text)) {
    for (const site::CellPlace& place : *places) check_place(place);
  }
  const auto claim = nats::read_claim("person.k1", text, 1);
  require(!claim || nats::read_claim("person.k1", nats::write_claim(*claim), 1).has_value());
  return 0;
}
