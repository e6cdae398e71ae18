#include "common/http/access.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/sha.h>

#include <algorithm>
#include <array>

#include "common/http/text.h"
#include "common/net/host_name.h"

namespace chorus::http {
namespace {

using Digest = std::array<unsigned char, SHA256_DIGEST_LENGTH>;

Digest digest_of(std::string_view text) {
  Digest digest{};
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  return digest;
}

/// "[::1]:80" -> "[::1]", "localhost:8080" -> "localhost".
std::string_view host_part(std::string_view authority) {
  const std::size_t bracket = authority.rfind(']');
  const std::size_t colon = authority.rfind(':');
  if (colon == std::string_view::npos) return authority;
  if (bracket != std::string_view::npos && colon < bracket) return authority;
  return authority.substr(0, colon);
}

/// True for an address or localhost: nobody can make DNS resolve these to another host.
bool is_fixed_name(std::string_view host) {
  if (equal_ignoring_case(host, "localhost") || host.starts_with('[')) return true;
  return !host.empty() && host.find_first_not_of("0123456789.") == std::string_view::npos;
}

/// What follows "scheme " in an Authorization field; none if the field has another scheme.
std::optional<std::string_view> credentials(const RequestHead& head, std::string_view scheme) {
  const std::string_view given = head.authorization;
  if (given.size() <= scheme.size() || given[scheme.size()] != ' ' ||
      !equal_ignoring_case(given.substr(0, scheme.size()), scheme)) {
    return std::nullopt;
  }
  return trimmed(given.substr(scheme.size()));
}

/// The password in Basic credentials (RFC 7617): what follows the colon, decoded.
std::optional<std::string> password_in(std::string_view encoded) {
  constexpr std::size_t kMost = 4096;
  if (encoded.empty() || encoded.size() % 4 != 0 || encoded.size() > kMost) return std::nullopt;
  std::string text(encoded.size() / 4 * 3, '\0');
  const int size = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                   reinterpret_cast<const unsigned char*>(encoded.data()),
                                   static_cast<int>(encoded.size()));
  if (size < 0) return std::nullopt;
  const std::size_t padding = encoded.ends_with("==") ? 2 : encoded.ends_with('=') ? 1 : 0;
  text.resize(static_cast<std::size_t>(size) - padding);
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return std::nullopt;
  return text.substr(colon + 1);
}

bool is_reading(const RequestHead& head) {
  return head.method == Method::Get || head.method == Method::Head;
}

/// The token in the request.
std::optional<std::string> secret_in(const RequestHead& head) {
  if (const auto bearer = credentials(head, "bearer")) return std::string(*bearer);
  const auto basic = credentials(head, "basic");
  return basic ? password_in(*basic) : std::nullopt;
}

/// The token, if it may allow what is needed.  Browsers attach Basic credentials to any request
/// that any page makes, so these never allow writing, nor opening a WebSocket by GET.
std::optional<std::string> usable_secret(const RequestHead& head, Role needed) {
  const bool reads = needed != Role::Control && is_reading(head);
  return reads || credentials(head, "bearer") ? secret_in(head) : std::nullopt;
}

/// The role of a token; none if it is none of ours.  Every token is compared, so that the time does
/// not reveal which one matched.
std::optional<Role> role_of(const std::optional<std::string>& secret, const Guard& guard) {
  if (!secret) return std::nullopt;
  std::optional<Role> best;
  for (const Token& token : guard.tokens) {
    if (same_secret(*secret, token.secret)) best = std::max(best, std::optional(token.role));
  }
  return best;
}

Error without_tokens(Role needed) {
  if (needed == Role::Control) {
    return {ErrorCode::Forbidden, "Authorization",
            "writing methods are refused from here: this service has no bearer token "
            "configured, so only direct requests from its own host are accepted"};
  }
  return {ErrorCode::Unauthorized, "Authorization",
          "this service listens to the network and has no token yet, so only its own host may "
          "read: set http.tokens in its configuration (chorus init writes one with tokens), then "
          "send one: \"Authorization: Bearer TOKEN\""};
}

}  // namespace

bool same_secret(std::string_view a, std::string_view b) {
  const Digest digest_a = digest_of(a);
  const Digest digest_b = digest_of(b);
  return CRYPTO_memcmp(digest_a.data(), digest_b.data(), digest_a.size()) == 0;
}

bool is_own_host(std::string_view host, const std::vector<std::string>& names) {
  std::string_view name = host_part(host);
  if (name.ends_with('.')) name.remove_suffix(1);
  return is_fixed_name(name) || std::any_of(names.begin(), names.end(), [&](const auto& known) {
           return equal_ignoring_case(name, known);
         });
}

std::vector<std::string> host_names() { return net::names_of(net::host_name()); }

bool from_own_page(const RequestHead& head) {
  // The page's origin is https if we, or a proxy in front of us, speak TLS.
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (is_present(head.origin) && head.origin.starts_with(scheme) &&
        equal_ignoring_case(head.origin.substr(scheme.size()), head.host))
      return true;
  }
  return false;
}

bool is_trusted_local(const RequestHead& head, const Peer& peer) {
  if (!peer.loopback || peer.proxy || is_present(head.forwarded)) return false;
  if (is_present(head.host) && !is_fixed_name(host_part(head.host))) return false;
  return !is_present(head.origin) || from_own_page(head);
}

bool Guard::knows_readers() const {
  return std::any_of(tokens.begin(), tokens.end(),
                     [](const Token& token) { return token.role < Role::Control; });
}

std::optional<Error> refuse_access(const RequestHead& head, const Peer& peer, Role needed,
                                   const Guard& guard) {
  const bool reading = needed != Role::Control;
  if (reading && !guard.guards_reading()) return std::nullopt;
  const bool trusts_local = reading ? !guard.knows_readers() : guard.tokens.empty();
  if (trusts_local && is_trusted_local(head, peer)) return std::nullopt;
  if (guard.tokens.empty()) return without_tokens(needed);
  const auto role = role_of(usable_secret(head, needed), guard);
  if (role && *role >= needed) return std::nullopt;
  if (role) {
    return Error{ErrorCode::Forbidden, "Authorization",
                 "this token has the role " + std::string(name_of(*role)) + ", and this needs " +
                     std::string(name_of(needed)) + ": send another one of this service"};
  }
  if (usable_secret(head, needed)) {
    return Error{ErrorCode::Unauthorized, "Authorization",
                 "the token that was sent is none of this service: send one with the role " +
                     std::string(name_of(needed)) + " (http.tokens in its configuration)"};
  }
  return Error{ErrorCode::Unauthorized, "Authorization",
               "send a bearer token of this service with the role " + std::string(name_of(needed)) +
                   " (http.tokens in its configuration): \"Authorization: Bearer TOKEN\""};
}

bool has_wrong_token(const RequestHead& head, const Guard& guard) {
  return is_present(head.authorization) && !guard.tokens.empty() &&
         !role_of(secret_in(head), guard);
}

std::string_view name_of(Role role) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"read", "images", "control"};
  return kNames[static_cast<std::size_t>(role)];
}

std::optional<Role> role_named(std::string_view name) {
  for (const Role role : {Role::Read, Role::Images, Role::Control}) {
    if (name_of(role) == name) return role;
  }
  return std::nullopt;
}

bool is_our_authority(std::string_view authority, const Peer& peer) {
  std::string_view host = host_part(authority);
  const std::string_view port = authority.substr(host.size());
  const std::string expected = ":" + std::to_string(peer.local_port);
  constexpr std::uint16_t kDefaultPort = 80;
  if (port.empty() ? peer.local_port != kDefaultPort : port != expected) return false;
  if (equal_ignoring_case(host, "localhost")) return peer.loopback;
  if (host.size() > 1 && host.front() == '[') host = host.substr(1, host.size() - 2);
  return equal_ignoring_case(host, peer.local_address);
}

}  // namespace chorus::http
