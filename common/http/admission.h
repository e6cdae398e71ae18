// Says for which client a request counts towards the limits if a proxy has forwarded it.
#pragma once

#include <optional>
#include <string>

#include "common/http/request_head.h"

namespace chorus::http {

/// The account of the client that a proxy names: the last address of X-Forwarded-For, which the
/// proxy itself wrote (the addresses before it came from the client and cannot be trusted).  None
/// if there is no valid one.
[[nodiscard]] std::optional<std::string> forwarded_account(const RequestHead& head);

}  // namespace chorus::http
