// Slows down whoever guesses at a bearer token.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

namespace chorus::http {

/// Ten wrong tokens from one address are checked as fast as they come, then one a second.  During
/// that second even the right one is not checked, or its answer would reveal it.  Addresses beyond
/// the first few thousand share one account.
class TokenTries {
 public:
  using Time = std::chrono::steady_clock::time_point;

  [[nodiscard]] bool may_try(const std::string& address, Time now) const;
  void note_wrong(const std::string& address, Time now);

 private:
  [[nodiscard]] const std::string& account(const std::string& address) const;

  std::map<std::string, Time> forgiven_;  ///< When an address has a clean record again.
};

}  // namespace chorus::http
