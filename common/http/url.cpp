#include "common/base/parse.h"
#include "common/http/client.h"
#include "common/http/client_wire.h"
#include "common/http/text.h"

namespace chorus::http {
namespace {

constexpr std::uint16_t kSecurePort = 443;

Result<void> read_port(std::string_view text, std::string_view url, std::uint16_t& port) {
  constexpr std::uint64_t kMaxPort = 65535;
  const auto number = parse_number<std::uint64_t>(text);
  if (!number || *number == 0 || *number > kMaxPort)
    return fail(ErrorCode::InvalidArgument, std::string(url), "a port is a number 1 to 65535");
  port = static_cast<std::uint16_t>(*number);
  return {};
}

bool is_plain(std::string_view text) {
  for (const char c : text) {
    if (c <= ' ' || c >= '\x7f' || c == '"' || c == '<' || c == '>' || c == '\\') return false;
  }
  return true;
}

/// True if `text` begins with `scheme`, in upper or lower case, and is longer.
bool begins_with(std::string_view text, std::string_view scheme) {
  return text.size() > scheme.size() && equal_ignoring_case(text.substr(0, scheme.size()), scheme);
}

}  // namespace

Result<Url> parse_url(std::string_view text) {
  constexpr std::string_view kAdvice = "write the address as http://host:port/path, or https://";
  const bool secure = begins_with(text, "https://");
  if ((!secure && !begins_with(text, "http://")) || !is_plain(text))
    return fail(ErrorCode::InvalidArgument, std::string(text), std::string(kAdvice));
  std::string_view rest = text.substr(text.find("//") + 2);
  rest = rest.substr(0, rest.find('#'));
  const std::size_t end = rest.find_first_of("/?");
  std::string_view authority = rest.substr(0, end);
  Url url;
  url.secure = secure;
  if (secure) url.port = kSecurePort;
  if (end != std::string_view::npos) url.target = rest.substr(end);
  if (url.target.front() == '?') url.target.insert(0, "/");
  const std::size_t bracket = authority.find(']');
  const std::size_t colon = authority.find(':', bracket == std::string_view::npos ? 0 : bracket);
  if (colon != std::string_view::npos) {
    if (auto ok = read_port(authority.substr(colon + 1), text, url.port); !ok) return pass(ok);
    authority = authority.substr(0, colon);
  }
  if (authority.starts_with('[') && authority.ends_with(']'))
    authority = authority.substr(1, authority.size() - 2);
  if (authority.empty() || authority.find_first_of("@[]") != std::string_view::npos)
    return fail(ErrorCode::InvalidArgument, std::string(text),
                "write the address as http://host:port/path, without a user name");
  url.host = authority;
  return url;
}

std::string url_text(const Url& url, std::string_view target) {
  return (url.secure ? "https://" : "http://") + authority_of(url.host, url.port) +
         std::string(target);
}

}  // namespace chorus::http
