// Sensors that announce themselves in the local network by multicast DNS (DNS-SD, RFC 6763), with
// Avahi.  This is a convenience: a configuration lists its sensors, and no sensor is followed just
// because it announces itself.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/asked_program.h"
#include "common/base/result.h"

namespace chorus::client {

/// Where avahi-daemon looks for services to announce.
inline constexpr const char* kAvahiFolder = "/etc/avahi/services";

struct FoundSensor {
  std::string id;
  std::string host;     ///< "sensor-1.local"
  std::string address;  ///< Numeric.
  std::uint16_t port = 0;
  bool tls = false;

  /// The URL of the sensor: with TLS by name, because certificates are issued for names; otherwise
  /// by address.
  [[nodiscard]] std::string url() const;
  bool operator==(const FoundSensor&) const = default;
};

/// The file for kAvahiFolder that announces a sensor.  It contains no secret.
[[nodiscard]] std::string announcement(const std::string& id, std::uint16_t port, bool tls);

/// Reads what `avahi-browse --resolve --parsable` prints; the result is in order of id. Lines with
/// the same id, host, port and TLS are one sensor, of which the best address is kept: IPv4, IPv6,
/// link-local, loopback. But without TLS, different addresses are different sensors, because one
/// may be a stranger's, unless one of them is loopback or begins with fe80. Anybody in the network
/// may announce anything, so lines without a valid id, name, port and address of one host are left
/// out, and of one address no more than 32 sensors are listed, of one id no more than 64.
[[nodiscard]] std::vector<FoundSensor> read_browsed(std::string_view text);

/// Asks Avahi; takes a second or two, and never longer than the limit: then what was found until
/// then is returned. Unsupported: avahi-browse is not installed; Unavailable: no daemon runs, or
/// Avahi failed; Timeout: it said nothing in time.
[[nodiscard]] Result<std::vector<FoundSensor>> discovered_sensors(const AskLimits& limits = {});

}  // namespace chorus::client
