#include "common/motion/text_lines.h"

#include <cmath>

#include "common/base/parse.h"

namespace chorus::motion {
namespace {

constexpr std::string_view kBlanks = " \t\r\f\v";

void split(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  while (words.size() < kMaxWordsPerLine) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

}  // namespace

bool TextLines::next() {
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    split(rest_.substr(0, end), words_);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    if (!words_.empty() && words_[0][0] != '#') return true;
  }
  words_.clear();
  return false;
}

bool read_finite(std::string_view word, double& out) {
  const auto value = parse_finite(word);
  if (value) out = *value;
  return value.has_value();
}

Result<std::vector<double>> TextLines::numbers(std::size_t first, std::size_t count) const {
  if (words_.size() < first + count) {
    return wrong("expected " + std::to_string(count) + " numbers, found " +
                 std::to_string(words_.size() < first ? 0 : words_.size() - first));
  }
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (!read_finite(words_[first + i], values[i])) {
      return wrong("'" + std::string(words_[first + i].substr(0, 40)) + "' is not a finite number");
    }
  }
  return values;
}

tl::unexpected<Error> TextLines::wrong(std::string message) const {
  return fail(ErrorCode::Malformed, origin_ + ":" + std::to_string(number_), std::move(message));
}

tl::unexpected<Error> TextLines::too_large(std::string message) const {
  return fail(ErrorCode::TooLarge, origin_ + ":" + std::to_string(number_), std::move(message));
}

}  // namespace chorus::motion
