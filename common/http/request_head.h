// Parses the head of a request strictly, without a socket: takes bytes, returns fields or a
// refusal.
//
// Refuses everything that two readers of HTTP could understand differently, because request
// smuggling relies on that: bare line feeds, folded lines, spaces before a colon, repeated Host or
// Content-Length, Transfer-Encoding (chunked gets 411), bodies on GET.  Boost.Beast accepts every
// head that is accepted here, with the same meaning; tests/fuzz/http_request compares the two.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/http/router.h"

namespace chorus::http {

/// Why a request is refused.  After the answer the connection is closed.
struct Refusal {
  int status = 400;
  std::string detail;
};

enum class HeadProgress { Incomplete, Complete, Broken };

struct HeadEnd {
  HeadProgress progress = HeadProgress::Incomplete;
  std::size_t size = 0;  ///< If complete: the size of the head including its blank line.
};

/// Looks for the blank line that ends the head; an earlier call has already examined the first
/// `checked` bytes.  Broken as soon as there is a line feed without a carriage return before it.
[[nodiscard]] HeadEnd find_head_end(std::string_view bytes, std::size_t checked) noexcept;

struct Field {
  std::string_view name;
  std::string_view value;
};

/// All views point into the bytes that read_head() was given, or into `joined`.
struct RequestHead {
  Method method = Method::Get;
  std::string_view path;       ///< As sent, percent-encoded, without the query.
  std::string_view query;      ///< Without '?'.
  std::string_view authority;  ///< From a target in absolute form; otherwise empty.
  bool asterisk = false;       ///< True for the target of "OPTIONS *".
  int minor_version = 1;       ///< HTTP/1.x
  bool keep_alive = true;
  bool expects_continue = false;
  std::uint64_t content_length = 0;

  // The fields that the server acts on; data() is null when a field is absent.  Values of a
  // repeated list field are joined with ", ".
  std::string_view host, accept, accept_encoding, if_none_match, prefer, authorization, origin,
      last_event_id, forwarded, connection, upgrade, length_text, transfer_encoding, expect;

  std::vector<Field> fields;       ///< All fields, in order.
  std::deque<std::string> joined;  ///< Storage of the joined lists.
};

[[nodiscard]] constexpr bool is_present(std::string_view field) noexcept {
  return field.data() != nullptr;
}

/// Fills `head` from the bytes of one complete head; returns no refusal when the head is valid.
/// Reusing the same `head` avoids allocations.
[[nodiscard]] std::optional<Refusal> read_head(std::string_view bytes, RequestHead& head);

}  // namespace chorus::http
