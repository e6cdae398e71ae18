// Reads any bytes as /orientations of a source: each document is read or refused, what was read is
// finite and can be written and read again, and the scan takes nothing that the parser refuses or
// reads otherwise.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/resource/orientations_resource.h"
#include "common/resource/orientations_scan.h"
#include "tests/fuzz/frame_checks.h"

namespace {

using namespace chorus;
using fuzz::require;

void check(const resource::OrientationsResource& said) {
  require(!said.instants.empty() && said.instants.size() <= resource::kMaxInstants);
  require(said.instants.back().captured == said.captured);
  for (const inertial::InertialFrame& frame : said.instants)
    for (const inertial::InertialReading& one : frame.readings)
      require(!one.inertial_from_sensor || one.inertial_from_sensor->coeffs().allFinite());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto read = resource::read_orientations(text, resource::Format::Json);
  if (read) {
    check(*read);
    const auto json = resource::write(*read, resource::Format::Json);
    require(resource::read_orientations(json, resource::Format::Json).has_value());
  }
  if (const auto scanned = resource::scan_orientations(text)) {
    const auto parsed = resource::parse_orientations(text);
    require(parsed.has_value());
    require(resource::write(*parsed, resource::Format::Json) ==
            resource::write(*scanned, resource::Format::Json));
  }
  return 0;
}
