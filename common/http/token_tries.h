// Slows down a client that guesses bearer tokens, and nobody else.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <string_view>

#include "common/base/duration.h"

namespace chorus::http {

/// Every token is looked at, and a right one is never held up: other programs at the same address,
/// or behind the same proxy, may guess as they like.  Only the answer to a wrong one is delayed.
/// Ten different wrong tokens from one address are answered at once; after that, the answers come
/// one a second, but none later than kLongestDelay.  A guesser that does not wait for the answer
/// has to open a connection for every guess, and net::AddressAllowance limits its requests; tokens
/// of 128 bits, as chorus init makes them, cannot be guessed at that rate.
///
/// A wrong token that the address sent a short while ago is answered at once and not counted,
/// because whoever repeats it learns nothing new.  While some thousand addresses are remembered,
/// all further ones are counted as one.
class TokenTries {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kLongestDelay{5};

  /// Counts a wrong token and returns how long its answer waits.  `authorization` is the value of
  /// the header field, by which tokens are told apart.
  [[nodiscard]] Duration note_wrong(const std::string& address, std::string_view authorization,
                                    Time now);

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
