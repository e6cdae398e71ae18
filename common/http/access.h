// Who may use writing methods.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/error.h"
#include "common/http/request_head.h"

namespace chorus::http {

/// Both ends of the connection a request came over.
struct Peer {
  bool loopback = false;
  std::string local_address = {};  ///< Ours, as text without port.
  std::uint16_t local_port = 0;
};

/// Constant time whatever the bytes are: compares SHA-256 digests.
[[nodiscard]] bool same_secret(std::string_view a, std::string_view b);

/// True for a request of a person or program on this host.  Not for one that a proxy handed on, nor
/// for a web page of some other origin that a browser on this host runs, DNS rebinding included.
[[nodiscard]] bool is_trusted_local(const RequestHead& head, const Peer& peer);

/// Nothing when a writing method is allowed: trusted local, or the right bearer token.
[[nodiscard]] std::optional<Error> refuse_writing(const RequestHead& head, const Peer& peer,
                                                  std::string_view bearer_token);

/// True when `authority` (host[:port] of an absolute-form target) is this end of the connection.
[[nodiscard]] bool is_our_authority(std::string_view authority, const Peer& peer);

}  // namespace chorus::http
