// The strict head reader compared with Boost.Beast: what we accept, Beast accepts in the same way.
//
// This is the purpose of being strict: no other HTTP reader, in a proxy in front of us or behind
// us, may understand an accepted request differently.  The reverse is not required: Beast accepts
// more.
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>

#include "common/http/beast.h"
#include "common/http/conditional.h"
#include "common/http/media_range.h"
#include "common/http/request_head.h"
#include "common/http/route_table.h"
#include "common/http/uri.h"

namespace {

using namespace chorus::http;
namespace beast = boost::beast::http;

void require(bool holds) {
  if (!holds) std::abort();
}

/// Reading in two parts finds the same end as reading all at once.
void check_resumed_reading(std::string_view bytes, const HeadEnd& whole) {
  const std::string_view half = bytes.substr(0, bytes.size() / 2);
  const HeadEnd first = find_head_end(half, 0);
  if (first.progress == HeadProgress::Incomplete) {
    const HeadEnd resumed = find_head_end(bytes, half.size());
    require(resumed.progress == whole.progress && resumed.size == whole.size);
  } else {
    require(first.progress == whole.progress && first.size == whole.size);
  }
}

/// By RFC 9112 9.3 a message with "close" ends the connection.  In HTTP/1.0 Beast lets keep-alive
/// override it.
bool kept_alive(const beast::request_parser<beast::string_body>& parser) {
  for (const auto& field : parser.get()) {
    if (field.name() == beast::field::connection &&
        beast::token_list(field.value()).exists("close")) {
      return false;
    }
  }
  return parser.keep_alive();
}

void check_against_beast(std::string_view bytes, const RequestHead& head) {
  beast::request_parser<beast::string_body> parser;
  parser.header_limit(1u << 20);
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());
  boost::system::error_code failed;
  parser.eager(false);
  parser.put(boost::asio::buffer(bytes.data(), bytes.size()), failed);
  require(!failed || failed == beast::error::need_more);
  require(parser.is_header_done());
  const auto& message = parser.get();
  const std::string_view method(message.method_string().data(), message.method_string().size());
  require(method == name_of(head.method));
  require(message.version() == 10u + static_cast<unsigned>(head.minor_version));
  require(kept_alive(parser) == head.keep_alive);
  require(!message.chunked());
  require(parser.content_length().value_or(0) == head.content_length);
  std::size_t fields = 0;
  for ([[maybe_unused]] const auto& field : message) ++fields;
  require(fields == head.fields.size());
}

void read_further(const RequestHead& head) {
  std::string storage;
  const auto path = decode_path(head.path, storage);
  if (path) require(path->find("/../") == std::string_view::npos);
  (void)decode_query(head.query);
  (void)none_match_lists(head.if_none_match, "\"1-ttl\"");
  (void)wait_preference(head.prefer);
  constexpr std::string_view kOffers[] = {"text/turtle", "application/json"};
  (void)negotiate(kOffers, head.accept);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const HeadEnd end = find_head_end(text, 0);
  check_resumed_reading(text, end);
  RequestHead head;
  if (end.progress != HeadProgress::Complete) {
    (void)read_head(text, head);  // Production code never does this, but it must be harmless.
    return 0;
  }
  if (read_head(text.substr(0, end.size), head)) return 0;
  check_against_beast(text.substr(0, end.size), head);
  read_further(head);
  return 0;
}
