#include "common/http/request_head.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "common/base/parse.h"
#include "common/http/route_table.h"
#include "common/http/status.h"
#include "common/http/text.h"

namespace chorus::http {
namespace {

constexpr std::size_t kMaxFields = 64;

using CharSet = std::array<bool, 256>;

constexpr CharSet chars(std::string_view also, int first, int last) {
  CharSet set{};
  for (int c = first; c <= last; ++c) set[static_cast<std::size_t>(c)] = true;
  for (char c = 'a'; c <= 'z'; ++c) set[static_cast<unsigned char>(c)] = true;
  for (char c = 'A'; c <= 'Z'; ++c) set[static_cast<unsigned char>(c)] = true;
  for (char c = '0'; c <= '9'; ++c) set[static_cast<unsigned char>(c)] = true;
  for (const char c : also) set[static_cast<unsigned char>(c)] = true;
  return set;
}

constexpr CharSet kToken = chars("!#$%&'*+-.^_`|~", '0', '9');        // RFC 9110 5.6.2
constexpr CharSet kTarget = chars("-._~!$&'()*+,;=:@/?%", '0', '9');  // RFC 3986, no '#', no '[]'
constexpr CharSet kHost = chars("-._~!$&'()*+,;=%[]:", '0', '9');     // RFC 3986 3.2.2 and port

/// Visible characters, space, tab and bytes above ASCII, but no control characters (RFC 9110 5.5).
constexpr CharSet value_chars() {
  CharSet set = chars("\t", ' ', '~');
  for (std::size_t c = 0x80; c < set.size(); ++c) set[c] = true;
  return set;
}
constexpr CharSet kValue = value_chars();

bool all_in(std::string_view text, const CharSet& set) {
  return std::all_of(text.begin(), text.end(),
                     [&](char c) { return set[static_cast<unsigned char>(c)]; });
}

struct KnownField {
  std::string_view name;
  std::string_view RequestHead::*member;
  bool list;  ///< The field may be repeated; its values form one list (RFC 9110 5.3).
};

constexpr std::array kKnown{
    KnownField{"host", &RequestHead::host, false},
    KnownField{"accept", &RequestHead::accept, true},
    KnownField{"accept-encoding", &RequestHead::accept_encoding, true},
    KnownField{"prefer", &RequestHead::prefer, true},
    KnownField{"if-none-match", &RequestHead::if_none_match, true},
    KnownField{"connection", &RequestHead::connection, true},
    KnownField{"upgrade", &RequestHead::upgrade, true},
    KnownField{"content-length", &RequestHead::length_text, false},
    KnownField{"transfer-encoding", &RequestHead::transfer_encoding, true},
    KnownField{"expect", &RequestHead::expect, false},
    KnownField{"authorization", &RequestHead::authorization, false},
    KnownField{"origin", &RequestHead::origin, false},
    KnownField{"last-event-id", &RequestHead::last_event_id, false},
    KnownField{"forwarded", &RequestHead::forwarded, true},
    KnownField{"x-forwarded-for", &RequestHead::forwarded, true},
    KnownField{"via", &RequestHead::forwarded, true},
};

Refusal bad(std::string detail) { return {status::kBadRequest, std::move(detail)}; }

std::optional<Refusal> note_known(const Field& field, RequestHead& head) {
  for (const KnownField& known : kKnown) {
    if (!equal_ignoring_case(known.name, field.name)) continue;
    std::string_view& value = head.*known.member;
    if (!is_present(value)) {
      value = field.value;
    } else if (known.list) {
      std::string both(value);
      value = head.joined.emplace_back(both.append(", ").append(field.value));
    } else {
      return bad("send the header field " + std::string(known.name) + " once, not twice");
    }
    break;
  }
  return {};
}

std::optional<Refusal> read_field(std::string_view line, RequestHead& head) {
  if (line.front() == ' ' || line.front() == '\t')
    return bad("header fields folded over several lines are not read; write each on one line");
  const std::size_t colon = line.find(':');
  const std::string_view name = line.substr(0, colon);
  if (colon == std::string_view::npos || name.empty() || !all_in(name, kToken))
    return bad("each header line is \"Name: value\" without a space before the colon");
  const std::string_view value = trimmed(line.substr(colon + 1));
  if (!all_in(value, kValue)) return bad("a header field holds a control character");
  if (head.fields.size() == kMaxFields)
    return Refusal{status::kFieldsTooLarge,
                   "send at most " + std::to_string(kMaxFields) + " header fields"};
  head.fields.push_back({name, value});
  return note_known(head.fields.back(), head);
}

std::optional<Method> method_named(std::string_view name) {
  for (const Method method : {Method::Get, Method::Head, Method::Options, Method::Post, Method::Put,
                              Method::Patch, Method::Delete}) {
    if (name_of(method) == name) return method;
  }
  return std::nullopt;
}

std::optional<Refusal> read_version(std::string_view version, RequestHead& head) {
  constexpr std::string_view kPrefix = "HTTP/";
  if (version == "HTTP/1.1" || version == "HTTP/1.0") {
    head.minor_version = version.back() - '0';
    head.keep_alive = head.minor_version == 1;
    return {};
  }
  if (version.starts_with(kPrefix))
    return Refusal{status::kVersionNotSupported, "this server speaks HTTP/1.1 and HTTP/1.0"};
  return bad("a request line is \"METHOD target HTTP/1.1\"");
}

std::optional<Refusal> read_target(std::string_view target, RequestHead& head) {
  constexpr std::string_view kScheme = "http://";
  if (target == "*" && head.method == Method::Options) {
    head.asterisk = true;
    return {};
  }
  if (target.size() > kScheme.size() &&
      equal_ignoring_case(target.substr(0, kScheme.size()), kScheme)) {
    target.remove_prefix(kScheme.size());
    const std::size_t end = std::min(target.find_first_of("/?"), target.size());
    head.authority = target.substr(0, end);
    target.remove_prefix(end);
    if (head.authority.empty() || !all_in(head.authority, kHost))
      return bad("the authority in the request target is not a host");
    if (target.empty()) target = "/";
  }
  if (target.empty() || target.front() != '/' || !all_in(target, kTarget))
    return bad("a request target is a path that begins with '/', percent-encoded where needed");
  const std::size_t question = target.find('?');
  head.path = target.substr(0, question);
  if (question != std::string_view::npos) head.query = target.substr(question + 1);
  return {};
}

std::optional<Refusal> read_request_line(std::string_view line, RequestHead& head) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == std::string_view::npos || first == last || first == 0)
    return bad("a request line is \"METHOD target HTTP/1.1\"");
  const std::string_view name = line.substr(0, first);
  if (!all_in(name, kToken)) return bad("the method is not a word");
  if (auto refusal = read_version(line.substr(last + 1), head)) return refusal;
  const auto method = method_named(name);
  if (!method)
    return Refusal{status::kNotImplemented,
                   "the method is not known here; those that are: GET, HEAD, OPTIONS, POST, PUT, "
                   "PATCH, DELETE, in capitals"};
  head.method = *method;
  return read_target(line.substr(first + 1, last - first - 1), head);
}

std::optional<Refusal> check_host(const RequestHead& head) {
  if (!is_present(head.host)) {
    if (head.minor_version == 0) return {};
    return bad("HTTP/1.1 needs a Host header field");
  }
  if (head.host.empty() || !all_in(head.host, kHost)) return bad("the Host field is not a host");
  if (!head.authority.empty() && !equal_ignoring_case(head.authority, head.host))
    return bad("the Host field and the request target name different hosts");
  return {};
}

std::optional<Refusal> check_framing(RequestHead& head) {
  if (is_present(head.transfer_encoding)) {
    if (is_present(head.length_text) || head.minor_version == 0)
      return bad("Transfer-Encoding with Content-Length or in HTTP/1.0 is refused");
    if (equal_ignoring_case(head.transfer_encoding, "chunked"))
      return Refusal{status::kLengthRequired,
                     "send the body with Content-Length instead of chunked"};
    return Refusal{status::kNotImplemented,
                   "this transfer coding is not known; send the body with Content-Length"};
  }
  if (is_present(head.length_text)) {
    const auto length = parse_number<std::uint64_t>(head.length_text);
    if (!length) return bad("Content-Length is one decimal number");
    head.content_length = *length;
  }
  const bool takes_no_body =
      head.method == Method::Get || head.method == Method::Head || head.method == Method::Options;
  if (takes_no_body && head.content_length > 0)
    return bad("this method takes no body; leave it out");
  return {};
}

std::optional<Refusal> check_expectation(RequestHead& head) {
  if (!is_present(head.expect)) return {};
  if (!equal_ignoring_case(head.expect, "100-continue"))
    return Refusal{status::kExpectationFailed, "the only expectation known here is 100-continue"};
  head.expects_continue = head.minor_version == 1 && head.content_length > 0;
  return {};
}

std::optional<Refusal> read_connection(RequestHead& head) {
  std::string_view list = head.connection;
  bool close = false;
  while (!list.empty()) {
    const std::string_view option = next_element(list, ',');
    if (!all_in(option, kToken)) return bad("Connection is a list of words");
    close |= equal_ignoring_case(option, "close");
    if (equal_ignoring_case(option, "keep-alive")) head.keep_alive = true;
  }
  if (close) head.keep_alive = false;
  return {};
}

/// Cuts one line off; find_head_end has checked that each line ends in CR LF.
std::string_view next_line(std::string_view& bytes) {
  const std::size_t end = std::min(bytes.find('\n'), bytes.size() - 1);
  const std::string_view line = bytes.substr(0, end - (end > 0 ? 1 : 0));
  bytes.remove_prefix(end + 1);
  return line;
}

void clear(RequestHead& head) {
  auto fields = std::move(head.fields);
  fields.clear();
  auto joined = std::move(head.joined);
  joined.clear();
  head = RequestHead{};
  head.fields = std::move(fields);
  head.joined = std::move(joined);
}

}  // namespace

HeadEnd find_head_end(std::string_view bytes, std::size_t checked) noexcept {
  std::size_t at = checked;
  while (at < bytes.size()) {
    const void* found = std::memchr(bytes.data() + at, '\n', bytes.size() - at);
    if (found == nullptr) break;
    const auto feed = static_cast<std::size_t>(static_cast<const char*>(found) - bytes.data());
    if (feed == 0 || bytes[feed - 1] != '\r') return {HeadProgress::Broken, 0};
    if (feed == 1 || bytes[feed - 2] == '\n') return {HeadProgress::Complete, feed + 1};
    at = feed + 1;
  }
  return {};
}

std::optional<Refusal> read_head(std::string_view bytes, RequestHead& head) {
  clear(head);
  if (bytes.empty()) return bad("the request is empty");
  if (auto refusal = read_request_line(next_line(bytes), head)) return refusal;
  while (!bytes.empty()) {
    const std::string_view line = next_line(bytes);
    if (line.empty()) break;
    if (auto refusal = read_field(line, head)) return refusal;
  }
  if (auto refusal = check_host(head)) return refusal;
  if (auto refusal = check_framing(head)) return refusal;
  if (auto refusal = check_expectation(head)) return refusal;
  return read_connection(head);
}

}  // namespace chorus::http
