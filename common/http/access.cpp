#include "common/http/access.h"

#include <openssl/crypto.h>
#include <openssl/sha.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "common/http/text.h"

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

/// An address or localhost: a name that DNS cannot point somewhere else.
bool is_fixed_name(std::string_view host) {
  if (equal_ignoring_case(host, "localhost") || host.starts_with('[')) return true;
  return !host.empty() && host.find_first_not_of("0123456789.") == std::string_view::npos;
}

constexpr std::string_view kBearer = "bearer ";

bool has_token(const RequestHead& head, std::string_view bearer_token) {
  std::string_view given = head.authorization;
  const bool is_bearer = given.size() > kBearer.size() &&
                         equal_ignoring_case(given.substr(0, kBearer.size()), kBearer);
  given.remove_prefix(std::min(given.size(), kBearer.size()));
  return is_bearer && same_secret(trimmed(given), bearer_token);
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

std::vector<std::string> host_names() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0 || name[0] == '\0') return {};
  return {name.data(), std::string(name.data()) + ".local"};
}

bool from_own_page(const RequestHead& head) {
  // Behind a proxy that ends TLS the page is https.
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

std::optional<Error> refuse_writing(const RequestHead& head, const Peer& peer,
                                    std::string_view bearer_token) {
  if (bearer_token.empty()) {
    if (is_trusted_local(head, peer)) return std::nullopt;
    return Error{ErrorCode::Forbidden, "Authorization",
                 "writing methods are refused from here: this service has no bearer token "
                 "configured, so only direct requests from its own host are accepted"};
  }
  if (has_token(head, bearer_token)) return std::nullopt;
  return Error{ErrorCode::Unauthorized, "Authorization",
               "send the bearer token of this service: \"Authorization: Bearer TOKEN\""};
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
