// Slows down a client that guesses bearer tokens.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

namespace chorus::http {

/// Ten wrong tokens from one address are checked at once, after that one a second.  Until that
/// second is over not even the right one is checked, because the answer would reveal it.  Addresses
/// beyond the first few thousand share one account.
class TokenTries {
 public:
  using Time = std::chrono::steady_clock::time_point;

  [[nodiscard]] bool may_try(const std::string& address, Time now) const;
  void note_wrong(const std::string& address, Time now);

 private:
  [[nodiscard]] const std::string& account(const std::string& address) const;

  std::map<std::string, Time> forgiven_;  ///< When the record of an address is clean again.
};

}  // namespace chorus::http
