// What would not work if a service started on this host now; said by --check and, where it does not
// end the service, at the start.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/http/server.h"
#include "common/service/recordings.h"
#include "common/time/ntp_status.h"

namespace chorus::service {

/// Sentences for people, each with what to do.
using Concerns = std::vector<std::string>;

/// Whether files could be made in it by this user, in the folder itself or, when it is not there
/// yet, by creating it. Changes nothing.
[[nodiscard]] Result<void> usable_folder(const std::string& folder);

/// Whether somebody could listen there now: Io when the port is taken or the address is not of this
/// host.
[[nodiscard]] Result<void> free_to_listen(const http::ServerConfig& config);

[[nodiscard]] std::optional<std::string> clock_concern(const NtpStatus& clock);

/// Those that every service shares: the port, the folder for recordings, the clock.
[[nodiscard]] Concerns common_concerns(const http::ServerConfig& http,
                                       const RecordingConfig& recording);

/// At the start: the clock, and the folder for recordings, which the service can run without.
void log_concerns(const RecordingConfig& recording);

}  // namespace chorus::service
