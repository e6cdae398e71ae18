#include "common/http/websocket_handshake.h"

#include "common/http/access.h"
#include "common/http/text.h"
#include "common/http/uri.h"

namespace chorus::http {
namespace {

bool names(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    if (equal_ignoring_case(next_element(list, ','), word)) return true;
  }
  return false;
}

constexpr std::size_t kLongestValue = 64;  // A valid key or version is shorter.

void add(std::string& text, const Field& field) {
  text.append(field.name).append(": ").append(field.value.substr(0, kLongestValue)).append("\r\n");
}

}  // namespace

bool asks_for_websocket(const RequestHead& head) {
  return head.method == Method::Get && names(head.upgrade, "websocket") &&
         names(head.connection, "upgrade");
}

bool may_open(const RequestHead& head, std::string_view allowed_origin) {
  return !is_present(head.origin) || from_own_page(head) || allowed_origin == "*" ||
         head.origin == allowed_origin;
}

Subprotocols subprotocols_of(const RequestHead& head, std::string_view protocol) {
  constexpr std::string_view kTokenMark = "chorus.token.";
  Subprotocols found;
  for (const Field& field : head.fields) {
    if (!equal_ignoring_case(field.name, "Sec-WebSocket-Protocol")) continue;
    for (std::string_view list = field.value; !list.empty();) {
      const std::string_view one = next_element(list, ',');
      if (one == protocol) found.named = true;
      if (!one.starts_with(kTokenMark)) continue;
      const auto decoded = decode_query("token=" + std::string(one.substr(kTokenMark.size())));
      if (decoded) found.token = decoded->at("token");
    }
  }
  return found;
}

std::string handshake_of(const RequestHead& head, std::string_view behind) {
  std::string text =
      "GET / HTTP/1.1\r\nHost: here\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n";
  for (const std::string_view name : {"Sec-WebSocket-Key", "Sec-WebSocket-Version"}) {
    for (const Field& field : head.fields) {
      if (equal_ignoring_case(field.name, name)) add(text, field);
    }
  }
  return text.append("\r\n").append(behind);
}

}  // namespace chorus::http
