// What `chorus status` says of the service that judges the tracker by worn sensors
// (chorus-evaluation).
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/client/service_client.h"

namespace chorus::ctl {

/// Where chorus-evaluation listens unless told otherwise.
inline constexpr int kEvaluationPort = 8092;

/// The /evaluation of the service at `url`, with CHORUS_TOKEN.  Without a url: what the tracker
/// relays of its own, otherwise that of the service at the usual port of the tracker's host, if it
/// judges this tracker; null if there is none.  No token is sent to a service that nobody named.
[[nodiscard]] Result<nlohmann::json> evaluation_of(const std::string& url,
                                                   const client::ServiceClient& tracker,
                                                   const std::string& tracker_url);

/// A line for each limb that is not well, such as "left forearm off by 70 deg for 4 s", those that
/// are off first, and one for all that are.  Empty for null.
[[nodiscard]] std::string judged_limbs(const nlohmann::json& evaluation);

}  // namespace chorus::ctl
