// Reads from a configuration which services are followed, and how.
#pragma once

#include <optional>

#include "common/base/config_reader.h"
#include "common/client/followers.h"

namespace chorus::client {

/// The section "poll": times, limits, whether event streams are used.
void read_timings(ConfigReader reader, PollTimings& out);

/// The authorities in the file "ca" of the section "poll": the same for all services, because these
/// are hosts of one workshop.
[[nodiscard]] tls::Trust read_trust(ConfigReader poll);

/// One entry: "id", "url", "token".  None, with a complaint, when the id or the url is none.
[[nodiscard]] std::optional<FollowedService> read_followed(ConfigReader& entry,
                                                           const tls::Trust& trust);

}  // namespace chorus::client
