// Slows down a client that guesses bearer tokens.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <string_view>

namespace chorus::http {

/// Ten different wrong tokens from one address are checked without delay; after that, one a second.
/// In between no new token is checked, not even the right one: were the right one let through while
/// the address is slowed, a guesser would know it from the answer, and could guess at full speed.
///
/// A wrong token that the address sent a short while ago is checked again without being counted,
/// because whoever repeats it learns nothing new.  So a program with an outdated token that asks
/// for ever does not hold up the others on its host.  While some thousand addresses are remembered,
/// all further ones are counted as one.
class TokenTries {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `authorization` is the value of the header field, by which tokens are told apart.
  [[nodiscard]] bool may_try(const std::string& address, std::string_view authorization,
                             Time now) const;
  void note_wrong(const std::string& address, std::string_view authorization, Time now);

 private:
  /// SHA-256, so that no guess can be made to look like one that was counted before.
  using Mark = std::array<unsigned char, 32>;

  struct Record {
    Time forgiven{};         ///< When the wrong tokens of the address are forgotten.
    std::deque<Mark> wrong;  ///< The last few of them, oldest first.
  };

  [[nodiscard]] static Mark mark_of(std::string_view authorization);
  [[nodiscard]] const std::string& account(const std::string& address) const;

  std::map<std::string, Record> records_;
};

}  // namespace chorus::http
