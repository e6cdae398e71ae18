// The names of this host.
#pragma once

#include <string>
#include <vector>

namespace chorus::net {

/// As the system has it; empty when it has none.
[[nodiscard]] std::string host_name();

/// The names under which a host of that name is asked: that name, its first part, and the first
/// part with ".local" (multicast DNS), each once; none for "".
[[nodiscard]] std::vector<std::string> names_of(const std::string& host_name);

}  // namespace chorus::net
