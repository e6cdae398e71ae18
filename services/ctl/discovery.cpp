#include "services/ctl/discovery.h"

#include <arpa/inet.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "common/base/parse.h"
#include "common/base/strong_id.h"

namespace chorus::ctl {
namespace {

constexpr std::size_t kMostSensors = 256;
constexpr std::size_t kMostBytes = 1u << 20;
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

bool is_address(const std::string& text) {
  std::array<unsigned char, 16> bytes{};
  return ::inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 ||
         ::inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
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

Error not_asked(int status, const std::string& said) {
  const bool ended = WIFEXITED(status);
  if (ended && WEXITSTATUS(status) == kNotInstalled)
    return {ErrorCode::Unsupported, "avahi-browse",
            "is not installed: apt install avahi-daemon avahi-utils; a list of sensors "
            "(--sensor ID=URL,TOKEN) needs neither"};
  if (said.find("Daemon not running") != std::string::npos)
    return {ErrorCode::Unavailable, "avahi-daemon",
            "is not running on this host: systemctl start avahi-daemon; a list of sensors "
            "(--sensor ID=URL,TOKEN) needs none"};
  return {ErrorCode::Unavailable, "avahi-browse", "failed: " + said};
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
  std::vector<FoundSensor> found;
  while (!text.empty() && found.size() < kMostSensors) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const auto sensor = sensor_in(line);
    if (!sensor) continue;
    const auto known = std::find_if(found.begin(), found.end(), [&](const FoundSensor& each) {
      return same_sensor(each, *sensor);
    });
    if (known == found.end()) {
      found.push_back(*sensor);
    } else if (rank_of(sensor->address) < rank_of(known->address)) {
      *known = *sensor;
    }
  }
  std::sort(found.begin(), found.end(), [](const FoundSensor& a, const FoundSensor& b) {
    return std::tie(a.id, a.host, a.port, a.tls, a.address) <
           std::tie(b.id, b.host, b.port, b.tls, b.address);
  });
  return found;
}

Result<std::vector<FoundSensor>> discovered_sensors() {
  // The command is fixed; it contains nothing from a caller or from the network.
  FILE* const pipe = ::popen(
      "avahi-browse --resolve --parsable --terminate --no-db-lookup _chorus-sensor._tcp 2>&1", "r");
  if (pipe == nullptr) return fail(ErrorCode::Io, "avahi-browse", "cannot be started");
  std::string said;
  std::array<char, 4096> piece{};
  for (std::size_t size = 1; size > 0;) {
    size = std::fread(piece.data(), 1, piece.size(), pipe);
    if (said.size() < kMostBytes) said.append(piece.data(), size);
  }
  const int status = ::pclose(pipe);
  if (status != 0) return tl::unexpected<Error>(not_asked(status, said));
  return read_browsed(said);
}

}  // namespace chorus::ctl
