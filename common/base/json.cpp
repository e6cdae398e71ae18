#include "common/base/json.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/shortened.h"

namespace chorus {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kShownKey = 80;  // Errors quote at most this much of a repeated key [bytes].

/// Thrown by the parser's callback; never leaves this file.
struct TooDeep : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Refuses what the parser would silently accept: repeated keys and unlimited nesting.
class StructureGuard {
 public:
  explicit StructureGuard(int nesting) : nesting_(nesting) {}

  bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    if ((event == Event::object_start || event == Event::array_start) && depth >= nesting_)
      throw TooDeep("brackets are nested deeper than " + std::to_string(nesting_));
    if (event == Event::object_start) open_.emplace_back();
    if (event == Event::object_end && !open_.empty()) open_.pop_back();
    if (event == Event::key && !open_.empty()) {
      const auto& key = parsed.get_ref<const std::string&>();
      if (!open_.back().insert(key).second && repeated_.empty()) repeated_ = key;
    }
    return true;
  }
  [[nodiscard]] const std::string& repeated() const { return repeated_; }

 private:
  int nesting_;
  std::vector<std::set<std::string>> open_;
  std::string repeated_;
};

/// The word that begins at or around the last byte that the parser took.
std::string_view word_at(std::string_view text, std::size_t byte) {
  constexpr std::string_view kEnds = " \t\r\n,:[]{}";
  std::size_t at = std::min(byte, text.size() - 1);
  while (at > 0 && kEnds.find(text[at]) != std::string_view::npos) --at;
  const std::size_t before = text.find_last_of(kEnds, at);
  const std::size_t from = before == std::string_view::npos ? 0 : before + 1;
  return text.substr(from, std::min(text.find_first_of(kEnds, from), text.size()) - from);
}

bool is_no_number(std::string_view word) {
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  return word.starts_with("NaN") || word.starts_with("nan") || word.starts_with("Inf") ||
         word.starts_with("inf");
}

/// "line 5, column 12" of a byte, both counted from 1.
std::string place_of(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto line = 1 + std::ranges::count(before, '\n');
  const std::size_t begin = before.rfind('\n');
  const std::size_t column = before.size() - (begin == std::string_view::npos ? 0 : begin + 1);
  return "line " + std::to_string(line) + ", column " + std::to_string(column + 1);
}

/// What is wrong, in words that need no knowledge of the parser.  Quotes little of the text, and
/// nothing of configurations (`quotes` is false), because these contain tokens.
std::string in_words(std::string_view text, const Json::parse_error& error, bool quotes) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return "is empty";
  const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;
  const std::string place = place_of(text, byte) + ": ";
  const std::string_view what = error.what();
  if (byte >= text.size() || what.find("unexpected end of input") != std::string_view::npos)
    return place + "the JSON ends too early; a bracket or a quotation mark is not closed";
  if (what.find("UTF-8") != std::string_view::npos)
    return place + "a text is not in UTF-8, or has a character that \\u must write";
  const std::string_view word = word_at(text, byte);
  if (is_no_number(word)) return place + "NaN and Infinity are no numbers in JSON";
  if (word.starts_with('\'')) return place + "JSON quotes texts with \", not with '";
  if (!quotes || word.empty()) return place + "this is no JSON";
  return place + "this is no JSON: " + shortened(word, kShownKey);
}

}  // namespace

Result<Json> parse_json(std::string_view text, const JsonLimits& limits) {
  if (text.size() > limits.bytes) {
    return fail(ErrorCode::TooLarge, {},
                "the document has " + std::to_string(text.size()) + " bytes; at most " +
                    std::to_string(limits.bytes) + " are read");
  }
  StructureGuard guard(limits.nesting);
  try {
    constexpr bool kExceptions = true;
    Json json = Json::parse(
        text,
        [&guard](int depth, Json::parse_event_t event, const Json& parsed) {
          return guard(depth, event, parsed);
        },
        kExceptions, limits.comments);
    if (guard.repeated().empty()) return json;
  } catch (const Json::parse_error& error) {
    return fail(ErrorCode::Malformed, {}, in_words(text, error, !limits.comments));
  } catch (const Json::exception&) {
    return fail(ErrorCode::Malformed, {}, "a number in it is too large");
  } catch (const TooDeep& error) {
    return fail(ErrorCode::TooLarge, {}, error.what());
  }
  return fail(ErrorCode::Malformed, guard.repeated().substr(0, kShownKey),
              "the key is given twice");
}

}  // namespace chorus
