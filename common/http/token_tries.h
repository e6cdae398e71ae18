// Slows down a client that guesses bearer tokens.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

namespace chorus::http {

/// Ten wrong tokens from one address are checked without delay; after that, one a second.  In
/// between no token is checked, not even the right one, because the answer would reveal that it is
/// right.  While some thousand addresses are remembered, all further ones are counted as one.
class TokenTries {
 public:
  using Time = std::chrono::steady_clock::time_point;

  [[nodiscard]] bool may_try(const std::string& address, Time now) const;
  void note_wrong(const std::string& address, Time now);

 private:
  [[nodiscard]] const std::string& account(const std::string& address) const;

  /// For each address, the time at which its wrong tokens are forgotten.
  std::map<std::string, Time> forgiven_;
};

}  // namespace chorus::http
