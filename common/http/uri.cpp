#include "common/http/uri.h"

#include <optional>

namespace chorus::http {
namespace {

std::optional<int> hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

/// The byte of the escape at text[at]; none when it is not an escape or is a control character.
std::optional<char> escaped_byte(std::string_view text, std::size_t at) {
  if (at + 2 >= text.size()) return std::nullopt;
  const auto high = hex_digit(text[at + 1]);
  const auto low = hex_digit(text[at + 2]);
  if (!high || !low) return std::nullopt;
  const int byte = *high * 16 + *low;
  constexpr int kFirstPrintable = 0x20;
  constexpr int kDelete = 0x7f;
  if (byte < kFirstPrintable || byte == kDelete) return std::nullopt;
  return static_cast<char>(byte);
}

Result<std::string> decode(std::string_view raw, std::string_view forbidden) {
  std::string text;
  text.reserve(raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] != '%') {
      text += raw[i];
      continue;
    }
    const auto byte = escaped_byte(raw, i);
    if (!byte || forbidden.find(*byte) != std::string_view::npos)
      return fail(ErrorCode::InvalidArgument, std::string(raw),
                  "the escape at character " + std::to_string(i) +
                      " is broken or stands for a character that is not allowed here");
    text += *byte;
    i += 2;
  }
  return text;
}

bool has_dot_segment(std::string_view path) {
  while (!path.empty()) {
    const std::size_t slash = path.find('/');
    const std::string_view segment = path.substr(0, slash);
    if (segment == "." || segment == "..") return true;
    if (slash == std::string_view::npos) break;
    path.remove_prefix(slash + 1);
  }
  return false;
}

}  // namespace

Result<std::string_view> decode_path(std::string_view raw, std::string& storage) {
  std::string_view path = raw;
  if (raw.find('%') != std::string_view::npos) {
    auto decoded = decode(raw, "/\\");
    if (!decoded) return pass(decoded);
    storage = std::move(*decoded);
    path = storage;
  }
  if (path.find("/.") != std::string_view::npos && has_dot_segment(path))
    return fail(ErrorCode::InvalidArgument, std::string(raw),
                "\".\" and \"..\" segments are not resolved here; send the path without them");
  return path;
}

Result<Query> decode_query(std::string_view raw) {
  Query query;
  while (!raw.empty()) {
    const std::size_t end = raw.find('&');
    const std::string_view pair = raw.substr(0, end);
    raw.remove_prefix(end == std::string_view::npos ? raw.size() : end + 1);
    if (pair.empty()) continue;
    const std::size_t equals = pair.find('=');
    auto key = decode(pair.substr(0, equals), "");
    if (!key) return pass(key);
    auto value =
        decode(equals == std::string_view::npos ? std::string_view() : pair.substr(equals + 1), "");
    if (!value) return pass(value);
    query.insert_or_assign(std::move(*key), std::move(*value));
  }
  return query;
}

}  // namespace chorus::http
