// Which client a proxy's request is counted for.
#pragma once

#include <optional>
#include <string>

#include "common/http/request_head.h"

namespace chorus::http {

/// The client that a proxy names: the last address of X-Forwarded-For, which the proxy itself wrote
/// (those before it came from the client).
[[nodiscard]] std::optional<std::string> forwarded_account(const RequestHead& head);

}  // namespace chorus::http
