// Who may read and who may write: by which name, from which page, from where, with which token.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/http/request_head.h"

namespace chorus::http {

/// Both ends of the connection a request came over.
struct Peer {
  bool loopback = false;
  std::string local_address = {};  ///< Ours, as text without port.
  std::uint16_t local_port = 0;
  /// One of ServerConfig::trusted_proxies: it forwards requests of others.
  bool proxy = false;
  std::string account = {};  ///< Whom limits count the connection for (net::account_of).
};

/// Constant time whatever the bytes are: compares SHA-256 digests.
[[nodiscard]] bool same_secret(std::string_view a, std::string_view b);

/// True when a Host field names this service: by an address, as localhost, or by one of `names`.
/// Any other name may belong to a web page whose owner points it here (DNS rebinding).
[[nodiscard]] bool is_own_host(std::string_view host, const std::vector<std::string>& names);

/// The name of this host, and the same with ".local".
[[nodiscard]] std::vector<std::string> host_names();

/// True for a request that a page of this very service makes.
[[nodiscard]] bool from_own_page(const RequestHead& head);

/// True for a request from a person or program on this host: not one that a proxy forwarded, and
/// not one that a web page of another origin made in a browser on this host (DNS rebinding
/// included).
[[nodiscard]] bool is_trusted_local(const RequestHead& head, const Peer& peer);

/// Nothing when a writing method is allowed: with the right bearer token if one is configured, else
/// for trusted local requests.  Being local does not replace the token: a proxy on this host is
/// local as well.
[[nodiscard]] std::optional<Error> refuse_writing(const RequestHead& head, const Peer& peer,
                                                  std::string_view bearer_token);

/// True when `authority` (host[:port] of an absolute-form target) is this end of the connection.
[[nodiscard]] bool is_our_authority(std::string_view authority, const Peer& peer);

}  // namespace chorus::http
