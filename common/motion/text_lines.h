// Lines of a motion file, split into words, with the line number for messages.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace chorus::motion {

/// Limits against hostile files; real motion files are far below them.
inline constexpr std::size_t kMaxTextBytes = 64u << 20;
inline constexpr std::size_t kMaxSegments = 512;
inline constexpr std::size_t kMaxFrames = 200'000;
inline constexpr std::size_t kMaxWordsPerLine = 4096;

class TextLines {
 public:
  /// `origin` names the file in messages ("02_01.amc").
  TextLines(std::string_view text, std::string_view origin) : rest_(text), origin_(origin) {}

  /// Moves to the next line that is neither empty nor a '#' comment; false at the end.
  bool next();

  [[nodiscard]] const std::vector<std::string_view>& words() const noexcept { return words_; }
  /// Word i, or "" if the line is shorter.
  [[nodiscard]] std::string_view word(std::size_t i) const {
    return i < words_.size() ? words_[i] : std::string_view();
  }
  [[nodiscard]] std::size_t number() const noexcept { return number_; }

  /// Reads `count` finite numbers from word `first` on.
  [[nodiscard]] Result<std::vector<double>> numbers(std::size_t first, std::size_t count) const;

  /// A Malformed error that names this line: "02_01.amc:17".
  [[nodiscard]] tl::unexpected<Error> wrong(std::string message) const;
  [[nodiscard]] tl::unexpected<Error> too_large(std::string message) const;

 private:
  std::string_view rest_;
  std::string origin_;
  std::size_t number_ = 0;
  std::vector<std::string_view> words_;
};

/// Reads one finite decimal number; false for anything else.
[[nodiscard]] bool read_finite(std::string_view word, double& out);

}  // namespace chorus::motion
