// Reads any bytes as a SlimeVR datagram, as each live stream and as each file of inertial sensors:
// values that can be relied on, or a reason.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "common/inertial/dot_csv.h"
#include "common/inertial/mocopi.h"
#include "common/inertial/mtw_log.h"
#include "common/inertial/neuron_bvh.h"
#include "common/inertial/orientation_table.h"
#include "common/inertial/rokoko.h"
#include "common/inertial/slimevr.h"
#include "common/inertial/vmc.h"

namespace {

using namespace chorus;
using namespace chorus::inertial;

void require(bool holds) {
  if (!holds) std::abort();
}

/// A rotation that was read is of unit length, and is read again from what is written of it.
void check_datagram(std::string_view bytes) {
  const auto packets = slimevr::parse(bytes);
  if (!packets) return;
  for (const slimevr::Packet& packet : *packets) {
    const auto* const rotation = std::get_if<slimevr::Rotation>(&packet.content);
    if (rotation == nullptr) continue;
    require(std::abs(rotation->world_from_tracker.norm() - 1.0) < 1e-6);
    require(slimevr::parse(slimevr::encode(packet)).has_value());
  }
}

void check_log(const Result<SensorLog>& log) {
  if (!log) return;
  require(!log->readings.empty());
  for (const InertialReading& reading : log->readings)
    require(std::abs(reading.inertial_from_sensor->norm() - 1.0) < 1e-6);
}

/// Whatever a stream holds, what comes out of it can be relied on, and the reader goes on.
void check_stream(StreamReader& reader, std::string_view bytes) {
  const std::string_view half = bytes.substr(0, bytes.size() / 2);
  for (const std::string_view part : {bytes, half, bytes}) {
    (void)reader.take(part, Timestamp{});
    auto frame = reader.instant(Timestamp{});
    if (frame) require(checked(std::move(*frame)).has_value());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  check_datagram(text);
  check_stream(*make_mocopi_reader(), text);
  check_stream(*make_vmc_reader(), text);
  check_stream(*make_vrchat_reader(), text);
  check_stream(*make_rokoko_reader(""), text);
  check_stream(*make_neuron_reader(), text);
  check_log(parse_mtw_log(text, "fuzz", "sensor"));
  check_log(parse_dot_csv(text, "fuzz"));
  if (const auto logs = parse_orientation_table(text, "fuzz"))
    for (const SensorLog& log : *logs) check_log(log);
  return 0;
}
