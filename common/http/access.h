// Who may read and who may write: checks the Host name, the origin, the peer and the token.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/http/request_head.h"
#include "common/http/role.h"

namespace chorus::http {

/// What is known about the two ends of the connection by which a request came.
struct Peer {
  bool loopback = false;
  std::string local_address = {};  ///< Our address on this connection, without the port.
  std::uint16_t local_port = 0;
  /// True if the peer is one of ServerConfig::trusted_proxies: it forwards the requests of others.
  bool proxy = false;
  std::string account = {};  ///< The account under which limits count the peer (net::account_of).
};

struct Token {
  std::string secret;
  Role role = Role::Control;

  bool operator==(const Token&) const = default;
};

/// What a server requires of its clients.
struct Guard {
  std::vector<Token> tokens = {};
  bool open = false;  ///< True if other hosts can reach the server.

  /// True if at least one token is for reading only; then every reader needs a token.
  [[nodiscard]] bool knows_readers() const;
  /// True if reading needs a token, at least for clients on other hosts.
  [[nodiscard]] bool guards_reading() const { return open || knows_readers(); }
};

/// Compares SHA-256 digests, so the time that it takes does not depend on the bytes.
[[nodiscard]] bool same_secret(std::string_view a, std::string_view b);

/// True when a Host field names this service: by an address, as localhost, or by one of `names`.
/// Any other name may belong to a foreign web page whose owner lets the name resolve to our address
/// (DNS rebinding).
[[nodiscard]] bool is_own_host(std::string_view host, const std::vector<std::string>& names);

/// The names by which clients may address this host (net::names_of).
[[nodiscard]] std::vector<std::string> host_names();

/// True for a request that comes from one of this service's own pages.
[[nodiscard]] bool from_own_page(const RequestHead& head);

/// True for a request that a person or program on this host made itself.  False for one that a
/// proxy forwarded, and for one that a web page of another origin made in a browser on this host
/// (DNS rebinding included).
[[nodiscard]] bool is_trusted_local(const RequestHead& head, const Peer& peer);

/// Returns no error when the request may do what `needed` covers.  Writing needs a token of role
/// Control if any token is configured; otherwise only trusted local requests may write.  If a token
/// for reading is configured, every reader needs a token, also on this host, because a proxy on
/// this host looks like a local client.  If none is, reading from an open server needs any token or
/// a trusted local request, and reading from any other server needs nothing.  A GET or HEAD that
/// needs less than Control may also send the token as the password of Basic authentication, for
/// which browsers prompt.
[[nodiscard]] std::optional<Error> refuse_access(const RequestHead& head, const Peer& peer,
                                                 Role needed, const Guard& guard);

/// True when the request carries credentials that are none of our tokens.  False if there are no
/// tokens.
[[nodiscard]] bool has_wrong_token(const RequestHead& head, const Guard& guard);

[[nodiscard]] std::string_view name_of(Role role) noexcept;
/// The role called "read", "images" or "control".
[[nodiscard]] std::optional<Role> role_named(std::string_view name);

/// True when `authority` (host[:port] of an absolute-form target) names our end of this connection.
[[nodiscard]] bool is_our_authority(std::string_view authority, const Peer& peer);

}  // namespace chorus::http
