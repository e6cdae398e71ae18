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

/// What a token allows; each role includes those before it.
enum class Role {
  Read,     ///< Everything but pictures and recordings.
  Images,   ///< These too (Router::shows_people).
  Control,  ///< Writing methods.
};

struct Token {
  std::string secret;
  Role role = Role::Control;

  bool operator==(const Token&) const = default;
};

/// What a server asks of those who come.
struct Guard {
  std::vector<Token> tokens = {};
  bool open = false;  ///< It listens to more than this host.

  /// Somebody has made tokens for reading, so that everybody needs one.
  [[nodiscard]] bool knows_readers() const;
  /// Reading needs a token, at least for others than this host.
  [[nodiscard]] bool guards_reading() const { return open || knows_readers(); }
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

/// Nothing when the request is allowed what it needs.  Writing: with a token of role Control if any
/// token is configured, else for trusted local requests.  Reading, on an open server: with a token,
/// or for trusted local requests while no token for reading is configured; elsewhere with a token
/// once there is one for reading.  Being local does not replace such tokens: a proxy on this host
/// is local as well.  For GET and HEAD the token may also come as the password of Basic
/// authentication, which browsers ask people for.
[[nodiscard]] std::optional<Error> refuse_access(const RequestHead& head, const Peer& peer,
                                                 Role needed, const Guard& guard);

/// True when the request names a token that is none of ours.
[[nodiscard]] bool has_wrong_token(const RequestHead& head, const Guard& guard);

[[nodiscard]] std::string_view name_of(Role role) noexcept;
/// "read", "images" or "control".
[[nodiscard]] std::optional<Role> role_named(std::string_view name);

/// True when `authority` (host[:port] of an absolute-form target) is this end of the connection.
[[nodiscard]] bool is_our_authority(std::string_view authority, const Peer& peer);

}  // namespace chorus::http
