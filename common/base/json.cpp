#include "common/base/json.h"

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

/// Shortens the quoted text that the parser puts into its messages, which may be the whole
/// document.  Leaves it out of those about configurations, because these contain tokens.
std::string with_short_quote(std::string text, bool quotes) {
  constexpr std::string_view kQuote = "; last read: '";
  constexpr std::size_t kLongestEnd = 60;  // "; expected end of input" and the like.
  const std::size_t begin = text.find(kQuote);
  if (begin == std::string::npos) return text;
  const std::size_t after = text.rfind("; expected ");
  const bool ends_there =
      after > begin && after != std::string::npos && text.size() - after < kLongestEnd;
  const std::string end = ends_there ? text.substr(after) : std::string();
  const std::size_t from = begin + kQuote.size();
  const std::size_t size = text.size() - end.size() - from;
  if (!quotes) return text.substr(0, begin) + end;
  if (size <= kShownKey) return text;
  return text.substr(0, from) + shortened(text.substr(from, size), kShownKey) + "'" + end;
}

/// "[json.exception.parse_error.101] parse error at line 1..." without the part in brackets.
std::string readable(const Json::exception& error, bool configuration) {
  const std::string_view what = error.what();
  const std::size_t end = what.find("] ");
  const auto words = end == std::string_view::npos ? what : what.substr(end + 2);
  return with_short_quote(std::string(words), !configuration);
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
  } catch (const Json::exception& error) {
    return fail(ErrorCode::Malformed, {}, readable(error, limits.comments));
  } catch (const TooDeep& error) {
    return fail(ErrorCode::TooLarge, {}, error.what());
  }
  return fail(ErrorCode::Malformed, guard.repeated().substr(0, kShownKey),
              "the key is given twice");
}

}  // namespace chorus
