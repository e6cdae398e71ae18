// What `chorus doctor` finds on this host: one line for each, with what to do when it is not well.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/time/ntp_status.h"

namespace chorus::ctl {

struct Finding {
  bool good = true;
  std::string subject;      ///< "clock", "port", "sensor s1"
  std::string words;        ///< What is the case.
  std::string advice = {};  ///< What to do; empty when it is good.
};
using Findings = std::vector<Finding>;

/// A service of this host, as its configuration has it.
struct ExaminedService {
  std::string kind;  ///< "sensor" or "fusion"
  std::string file;
  nlohmann::json config;  ///< An object.

  [[nodiscard]] std::uint16_t port() const;
  /// Where to ask it from this host: "http://127.0.0.1:8081/".
  [[nodiscard]] std::string url() const;
  /// A token that may read; empty: it has none.
  [[nodiscard]] std::string read_token() const;
};

/// Io or Malformed, with the file.
[[nodiscard]] Result<ExaminedService> examined_service(const std::string& kind,
                                                       const std::string& file);

[[nodiscard]] Finding clock_finding(const NtpStatus& clock);
/// Whether the service is there and has everything it needs, by its own words.
[[nodiscard]] Finding health_finding(const ExaminedService& service);
/// Whether a token of its configuration is taken.
[[nodiscard]] Finding token_finding(const ExaminedService& service);
/// Its folders: there, and with room.
[[nodiscard]] Findings disk_findings(const ExaminedService& service);
/// One for each sensor of a fusion server: reached, let in, of our version, clocks within 20 ms.
[[nodiscard]] Findings sensor_findings(const ExaminedService& service);

}  // namespace chorus::ctl
