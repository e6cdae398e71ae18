// What `chorus doctor` finds on this host: one line each, with advice when something is wrong.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/http/client.h"
#include "common/time/ntp_status.h"

namespace chorus::ctl {

struct Finding {
  bool good = true;
  std::string subject;      ///< "clock", "port", "sensor s1"
  std::string words;        ///< What was found.
  std::string advice = {};  ///< What to do; empty when all is well.
};
using Findings = std::vector<Finding>;

/// A service of this host, as its configuration describes it.
struct ExaminedService {
  std::string kind;  ///< "sensor" or "fusion"
  std::string file;
  nlohmann::json config;  ///< A JSON object.

  [[nodiscard]] std::uint16_t port() const;
  /// The address to reach it from this host: "http://127.0.0.1:8081/", or https:// with a name from
  /// its certificate.
  [[nodiscard]] std::string url() const;
  /// The file of the service's certificate; empty: the service uses no TLS.
  [[nodiscard]] std::string certificate() const;
  /// A token that may read; empty when there is none.
  [[nodiscard]] std::string read_token() const;
};

/// Asks the service, as this host reaches it, with its own read token.
[[nodiscard]] Result<http::ClientResponse> ask_service(const ExaminedService& service,
                                                       const std::string& path);

/// Io or Malformed; the error names the file.
[[nodiscard]] Result<ExaminedService> examined_service(const std::string& kind,
                                                       const std::string& file);

[[nodiscard]] Finding clock_finding(const NtpStatus& clock);
/// Asks the service whether it is running and has everything it needs.
[[nodiscard]] Finding health_finding(const ExaminedService& service);
/// Whether the service accepts a token of its own configuration.
[[nodiscard]] Finding token_finding(const ExaminedService& service);
/// Whether the service's certificate, if it has one, can be read and is valid for at least another
/// month.
[[nodiscard]] Findings certificate_findings(const ExaminedService& service);
/// Whether there is room on the disks of the service's folders, and whether its user may write
/// there.
[[nodiscard]] Findings disk_findings(const ExaminedService& service,
                                     const std::string& user = "chorus");
/// One per sensor of a fusion server: reachable, token accepted, same version, clock within 20 ms.
[[nodiscard]] Findings sensor_findings(const ExaminedService& service);

}  // namespace chorus::ctl
