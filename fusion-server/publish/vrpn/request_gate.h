// Which datagrams make us connect to somebody: few, and each client once.  Pure.
//
// Anybody can send a datagram in anybody's name, so connecting back is limited in number at a time
// and in rate; VRPN's clients ask again every two seconds until they are heard.
#pragma once

#include <chrono>
#include <cstddef>
#include <set>
#include <string>

namespace chorus::publish::vrpn {

using SteadyTime = std::chrono::steady_clock::time_point;

struct GateLimits {
  std::size_t most_under_way = 32;  ///< Connections being made.
  double per_second = 32.0;
  double burst = 64.0;
};

class RequestGate {
 public:
  enum class Verdict { Connect, Repeated, Refused };

  explicit RequestGate(GateLimits limits = {}) : limits_(limits), allowance_(limits.burst) {}

  /// `asker` is "ADDRESS:PORT".  After Connect, say connected() or gone().
  [[nodiscard]] Verdict ask(const std::string& asker, SteadyTime now);
  void connected(const std::string& asker) { under_way_.erase(asker); }
  /// It may ask again.
  void gone(const std::string& asker);

 private:
  GateLimits limits_;
  double allowance_;
  SteadyTime counted_{};
  std::set<std::string> known_;  ///< Under way or connected.
  std::set<std::string> under_way_;
};

}  // namespace chorus::publish::vrpn
