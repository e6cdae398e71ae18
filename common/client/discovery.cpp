#include "common/client/discovery.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "common/base/parse.h"
#include "common/base/strong_id.h"

namespace chorus::client {
namespace {

// So that one host that announces thousands cannot hide the others, and comparing them stays quick.
constexpr std::size_t kMostOfAddress = 32;
constexpr std::size_t kMostOfId = 64;
constexpr std::size_t kLongestHost = 253;
constexpr int kNotInstalled = 127;  // The shell's exit code when there is no such program.

/// The fields of a line about a resolved service; such a line begins with "=".
enum Field { Mark, Interface, Protocol, Name, Type, Domain, Host, Address, Port, Texts, Count };

std::optional<std::array<std::string_view, Count>> fields_of(std::string_view line) {
  std::array<std::string_view, Count> fields;
  for (std::size_t i = 0; i + 1 < fields.size(); ++i) {
    const std::size_t end = line.find(';');
    if (end == std::string_view::npos) return std::nullopt;
    fields[i] = line.substr(0, end);
    line.remove_prefix(end + 1);
  }
  fields[Texts] = line;
  return fields;
}

/// The value of a key in a list such as: "tls=1" "id=s1"
std::string text_of(std::string_view texts, const std::string& key) {
  const std::size_t at = texts.find("\"" + key + "=");
  if (at == std::string_view::npos) return {};
  const std::string_view value = texts.substr(at + key.size() + 2);
  return std::string(value.substr(0, value.find('"')));
}

bool is_host(std::string_view host) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '.'; };
  return !host.empty() && host.size() <= kLongestHost &&
         std::all_of(host.begin(), host.end(), fits);
}

/// True for the numeric address of one host: no group, no broadcast, and not "any" (0.0.0.0, ::).
bool is_address(const std::string& text) {
  in_addr four{};
  if (::inet_pton(AF_INET, text.c_str(), &four) == 1) {
    const std::uint32_t value = ntohl(four.s_addr);
    return (value >> 24U) != 0 && !IN_MULTICAST(value) && !IN_BADCLASS(value);
  }
  in6_addr six{};
  return ::inet_pton(AF_INET6, text.c_str(), &six) == 1 && !IN6_IS_ADDR_UNSPECIFIED(&six) &&
         !IN6_IS_ADDR_MULTICAST(&six) && !IN6_IS_ADDR_V4MAPPED(&six);
}

std::optional<FoundSensor> sensor_in(std::string_view line) {
  const auto fields = fields_of(line);
  if (!fields || (*fields)[Mark] != "=") return std::nullopt;
  const auto port = parse_number<std::uint16_t>((*fields)[Port]);
  FoundSensor sensor{text_of((*fields)[Texts], "id"), std::string((*fields)[Host]),
                     std::string((*fields)[Address]), port.value_or(0),
                     text_of((*fields)[Texts], "tls") == "1"};
  const bool valid = SensorId::parse(sensor.id) && is_host(sensor.host) &&
                     is_address(sensor.address) && sensor.port > 0;
  return valid ? std::optional(sensor) : std::nullopt;
}

/// How suitable an address is; a smaller number is better.
int rank_of(const std::string& address) {
  if (address.starts_with("127.") || address == "::1") return 4;
  if (address.starts_with("fe80:")) return 3;
  if (address.starts_with("169.254.")) return 2;
  return address.find(':') == std::string::npos ? 0 : 1;
}

/// True for loopback addresses, and for addresses that are useless without the name of an
/// interface: announcing these misleads nobody.
bool leads_nowhere(const std::string& address) { return rank_of(address) >= 3; }

/// Whether both are the same sensor, perhaps at different addresses.  The id alone does not decide:
/// anybody may announce an id, and must not take the place of the sensor to which it belongs.  With
/// TLS, sensors are asked by name, and the certificate proves the name; without TLS, only the
/// address distinguishes two hosts.
bool same_sensor(const FoundSensor& a, const FoundSensor& b) {
  const bool same_place =
      a.tls || a.address == b.address || leads_nowhere(a.address) || leads_nowhere(b.address);
  return a.id == b.id && a.host == b.host && a.port == b.port && a.tls == b.tls && same_place;
}

Error not_asked(const Asked& asked) {
  if (asked.cut_short)
    return {
        ErrorCode::Timeout, "avahi-browse",
        "said nothing in time: is avahi-daemon well (systemctl status avahi-daemon)?  A list of "
        "sensors (--sensor ID=URL,TOKEN) needs neither"};
  if (asked.code == kNotInstalled)
    return {ErrorCode::Unsupported, "avahi-browse",
            "is not installed: apt install avahi-daemon avahi-utils; a list of sensors "
            "(--sensor ID=URL,TOKEN) needs neither"};
  if (asked.said.find("Daemon not running") != std::string::npos)
    return {ErrorCode::Unavailable, "avahi-daemon",
            "is not running on this host: systemctl start avahi-daemon; a list of sensors "
            "(--sensor ID=URL,TOKEN) needs none"};
  return {ErrorCode::Unavailable, "avahi-browse", "failed: " + asked.said};
}

}  // namespace

std::string FoundSensor::url() const {
  const std::string shown = address.find(':') == std::string::npos ? address : "[" + address + "]";
  return tls ? fmt::format("https://{}:{}/", host, port)
             : fmt::format("http://{}:{}/", shown, port);
}

std::string announcement(const std::string& id, std::uint16_t port, bool tls) {
  return fmt::format(R"(<?xml version="1.0" standalone="no"?>
<!DOCTYPE service-group SYSTEM "avahi-service.dtd">
<!-- Written by chorus init: this host has a sensor.  Delete the file to keep that to yourself. -->
<service-group>
  <name replace-wildcards="yes">Chorus sensor {0} on %h</name>
  <service>
    <type>_chorus-sensor._tcp</type>
    <port>{1}</port>
    <txt-record>id={0}</txt-record>
    <txt-record>tls={2}</txt-record>
  </service>
</service-group>
)",
                     id, port, tls ? 1 : 0);
}

std::vector<FoundSensor> read_browsed(std::string_view text) {
  std::map<std::string, std::vector<FoundSensor>> by_id;
  std::map<std::string, std::size_t> of_address;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const auto sensor = sensor_in(line);
    if (!sensor) continue;
    std::vector<FoundSensor>& alike = by_id[sensor->id];
    const auto known = std::find_if(alike.begin(), alike.end(), [&](const FoundSensor& each) {
      return same_sensor(each, *sensor);
    });
    if (known != alike.end()) {
      if (rank_of(sensor->address) < rank_of(known->address)) *known = *sensor;
    } else if (alike.size() < kMostOfId && of_address[sensor->address] < kMostOfAddress) {
      ++of_address[sensor->address];
      alike.push_back(*sensor);
    }
  }
  std::vector<FoundSensor> found;
  for (const auto& [id, alike] : by_id) found.insert(found.end(), alike.begin(), alike.end());
  std::sort(found.begin(), found.end(), [](const FoundSensor& a, const FoundSensor& b) {
    return std::tie(a.id, a.host, a.port, a.tls, a.address) <
           std::tie(b.id, b.host, b.port, b.tls, b.address);
  });
  return found;
}

Result<std::vector<FoundSensor>> discovered_sensors(const AskLimits& limits) {
  // The command is fixed; it contains nothing from a caller or from the network.
  const auto asked = ask_program({"avahi-browse", "--resolve", "--parsable", "--terminate",
                                  "--no-db-lookup", "_chorus-sensor._tcp"},
                                 limits);
  if (!asked) return pass(asked);
  // What it said until it was ended is as good as the rest: a flood, or a host that does not
  // resolve, must not hide the sensors that were found.
  if (asked->cut_short && !asked->said.empty()) return read_browsed(asked->said);
  if (asked->code != 0) return tl::unexpected<Error>(not_asked(*asked));
  return read_browsed(asked->said);
}

}  // namespace chorus::client
