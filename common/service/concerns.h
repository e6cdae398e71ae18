// Finds what would not work if a service started on this host now.  `--check` reports all of it.
// At the start, only those concerns are logged that do not end the service.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/http/server.h"
#include "common/service/recordings.h"
#include "common/time/ntp_status.h"

namespace chorus::service {

/// Human-readable sentences, each with advice.
using Concerns = std::vector<std::string>;

/// Success if this user can create files in the folder or, if it does not exist yet, can create the
/// folder; tries it, and leaves nothing behind.
[[nodiscard]] Result<void> usable_folder(const std::string& folder);

/// Success if a server could listen at this address now; Io when the port is taken or the address
/// is not one of this host's.
[[nodiscard]] Result<void> free_to_listen(const http::ServerConfig& config);

[[nodiscard]] std::optional<std::string> clock_concern(const NtpStatus& clock);

/// A sentence if the certificate of this server is not good at this time; none without TLS.
[[nodiscard]] std::optional<std::string> certificate_concern(const http::ServerConfig& config,
                                                             std::chrono::sys_seconds now);

/// The concerns that all services share: the port, the certificate, the folder for recordings, the
/// clock.
[[nodiscard]] Concerns common_concerns(const http::ServerConfig& http,
                                       const RecordingConfig& recording);

/// Logs, at the start, concerns about the certificate, the clock and the folder for recordings;
/// none ends the service.
void log_concerns(const http::ServerConfig& http, const RecordingConfig& recording);

}  // namespace chorus::service
