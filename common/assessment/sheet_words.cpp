#include "common/assessment/sheet_words.h"

#include <map>

#include "sheet_text.h"

namespace chorus::assessment {
namespace {

using Words = std::map<std::string_view, ergonomics::Text, std::less<>>;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// What stands before the mark, which is taken off `rest`; all of it if there is no mark.
std::string_view taken(std::string_view& rest, char mark) {
  const auto end = rest.find(mark);
  const std::string_view part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  return trimmed(part);
}

Words words_in(std::string_view text) {
  Words words;
  while (!text.empty()) {
    std::string_view line = taken(text, '\n');
    if (line.empty() || line.front() == '#') continue;
    const std::string_view key = taken(line, '|');
    const std::string_view english = taken(line, '|');
    words[key] = {english, taken(line, '|')};
  }
  return words;
}

}  // namespace

ergonomics::Text word(std::string_view key) {
  static const Words kWords = words_in(printed::words);
  const auto found = kWords.find(key);
  return found == kWords.end() ? ergonomics::Text{key, key} : found->second;
}

}  // namespace chorus::assessment
