#include "common/rdf/turtle_guard.h"

#include <array>
#include <string>

namespace chorus::rdf {
namespace {

constexpr auto kNotInIri = [] {
  std::array<bool, 256> never{};
  for (std::size_t c = 0; c <= 0x20; ++c) never[c] = true;
  for (const char c : std::string_view("<\"{}|^`")) never[static_cast<unsigned char>(c)] = true;
  return never;
}();

/// One pass over the text; every skip_ function starts after the opening character.
class Scan {
 public:
  Scan(std::string_view text, const Limits& limits) : text_(text), limits_(limits) {}

  Result<void> run() {
    while (at_ < text_.size()) {
      if (auto ok = step(text_[at_++]); !ok) return ok;
    }
    return {};
  }

 private:
  Result<void> step(char c) {
    switch (c) {
      case '\0':
        return refuse("a zero byte is no part of a text");
      case '\n':
        ++line_;
        return {};
      case '\\':
        ++at_;
        return {};  // An escaped character in a local name is not an opening bracket.
      case '#':
        skip_comment();
        return {};
      case '<':
        return skip_iri();
      case '"':
      case '\'':
        return skip_string(c);
      case '[':
      case '(':
        return open();
      case ']':
      case ')':
        --depth_;
        return {};
      default:
        return {};
    }
  }

  Result<void> open() {
    if (++depth_ <= limits_.nesting) return {};
    return fail(ErrorCode::TooLarge, where(),
                "brackets are nested deeper than " + std::to_string(limits_.nesting));
  }

  void skip_comment() {
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r' && text_[at_] != '\0')
      ++at_;
  }

  Result<void> skip_iri() {
    while (at_ < text_.size()) {
      const char c = text_[at_++];
      if (c == '>') return {};
      if (kNotInIri[static_cast<unsigned char>(c)]) {
        return refuse("an IRI holds a character it must not hold, or lacks its '>'");
      }
    }
    return refuse("the document ends inside an IRI");
  }

  Result<void> skip_string(char quote) {
    if (text_.substr(at_, 2) == std::string(2, quote)) {
      at_ += 2;
      return skip_long_string(quote);
    }
    while (at_ < text_.size()) {
      const char c = text_[at_++];
      if (c == quote) return {};
      if (c == '\\') ++at_;
      if (c == '\n' || c == '\r' || c == '\0') return refuse("a string lacks its closing quote");
    }
    return refuse("the document ends inside a string");
  }

  Result<void> skip_long_string(char quote) {
    const std::string closing(3, quote);
    while (at_ < text_.size()) {
      if (text_.substr(at_, 3) == closing) {
        at_ += 3;
        return {};
      }
      const char c = text_[at_++];
      // In '"\n' Serd 0.30 takes the backslash for an ordinary character, and would therefore take
      // an escaped quote for the closing one.
      if (c == quote && at_ < text_.size() && text_[at_] == '\\') {
        return refuse(
            "a quote directly before an escape in a long string is not read; escape the quote");
      }
      if (c == '\\') ++at_;
      if (c == '\n') ++line_;
      if (c == '\0') return refuse("a zero byte is no part of a text");
    }
    return refuse("the document ends inside a string");
  }

  [[nodiscard]] std::string where() const { return "line " + std::to_string(line_); }
  [[nodiscard]] Result<void> refuse(std::string message) const {
    return fail(ErrorCode::Malformed, where(), std::move(message));
  }

  std::string_view text_;
  const Limits& limits_;
  std::size_t at_ = 0;
  int line_ = 1;
  int depth_ = 0;
};

}  // namespace

Result<void> check_bytes(std::string_view text, const Limits& limits) {
  if (text.size() > limits.bytes) {
    return fail(ErrorCode::TooLarge, {},
                "the document has " + std::to_string(text.size()) + " bytes; at most " +
                    std::to_string(limits.bytes) + " are read");
  }
  return Scan(text, limits).run();
}

}  // namespace chorus::rdf
