// The names of this host.
#pragma once

#include <string>
#include <vector>

namespace chorus::net {

/// The name that is configured in the system; empty if there is none.
[[nodiscard]] std::string host_name();

/// The names by which clients may address a host of that name: the name, its first part, and that
/// part with ".local" (multicast DNS), each once; none for "".
[[nodiscard]] std::vector<std::string> names_of(const std::string& host_name);

}  // namespace chorus::net
