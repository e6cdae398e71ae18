// What to say when a resource of a fusion server is missing: the address may be a sensor's.
#pragma once

#include <string>

#include "common/base/error.h"

namespace chorus::client {
class ServiceClient;
}

namespace chorus::ctl {

/// `error`, or that the service at `url` is a sensor, which has no such resource.
[[nodiscard]] Error no_fusion_server(const client::ServiceClient& server, const std::string& url,
                                     Error error);

}  // namespace chorus::ctl
