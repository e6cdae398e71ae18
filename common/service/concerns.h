// What would not work if a service started on this host now; --check reports it and, unless it ends
// the service, so does the start.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/http/server.h"
#include "common/service/recordings.h"
#include "common/time/ntp_status.h"

namespace chorus::service {

/// Sentences for people, each with advice.
using Concerns = std::vector<std::string>;

/// Whether this user could create files in the folder, or could create the folder if it does not
/// exist yet. Changes nothing.
[[nodiscard]] Result<void> usable_folder(const std::string& folder);

/// Whether one could listen there now: Io when the port is taken or the address is not one of this
/// host.
[[nodiscard]] Result<void> free_to_listen(const http::ServerConfig& config);

[[nodiscard]] std::optional<std::string> clock_concern(const NtpStatus& clock);

/// The concerns that all services share: the port, the folder for recordings, the clock.
[[nodiscard]] Concerns common_concerns(const http::ServerConfig& http,
                                       const RecordingConfig& recording);

/// At the start: logs concerns about the clock and the folder for recordings; neither is fatal.
void log_concerns(const RecordingConfig& recording);

}  // namespace chorus::service
