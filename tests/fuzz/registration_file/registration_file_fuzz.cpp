// Reads any bytes as a registration file: places or an Error, never a crash; accepted places are
// finite, and after being written they read as the same places.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "fusion-server/wire/registration_file.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto read = chorus::wire::read_registration(text);
  if (!read) {
    require(!read.error().message.empty());
    return 0;
  }
  require(!read->sensors.empty() && read->sensors.contains(read->master));
  const auto again = chorus::wire::read_registration(chorus::wire::write_registration(*read));
  require(again.has_value() && again->sensors.size() == read->sensors.size());
  for (const auto& [id, place] : read->sensors) {
    const auto same = again->sensors.find(id);
    require(same != again->sensors.end() && place.world_from_sensor.matrix().allFinite());
    require(place.world_from_sensor.isApprox(same->second.world_from_sensor, 1e-9));
  }
  return 0;
}
