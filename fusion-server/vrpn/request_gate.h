// Which datagrams make us connect to their sender: few, and each client once.  Pure.
//
// Anybody can send a datagram in anybody's name, so connections back are limited in number and in
// rate: per address, so that one host's flood leaves room for the others, and in total.  A failed
// connection costs its address more.  VRPN's clients ask again every two seconds until they are
// heard.  A flood in the names of very many addresses can still use up the total; the protocol has
// no means to tell.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "common/net/token_bucket.h"

namespace chorus::vrpn {

struct GateLimits {
  std::size_t most_under_way = 32;  ///< Connections being made.
  net::Allowance all{32.0, 64.0};
  std::size_t most_of_source = 8;  ///< Being made to one address.
  net::Allowance source{16.0, 32.0};
  double failure = 4.0;  ///< Extra cost to an address when a connection fails.
  /// Addresses with an allowance of their own; all others share one.
  std::size_t most_sources = 256;
};

/// Who asks, and where it wants to be connected to.
struct Asker {
  std::string address;
  std::uint16_t port = 0;

  auto operator<=>(const Asker&) const = default;
};

class RequestGate {
 public:
  enum class Verdict { Connect, Repeated, Refused };

  explicit RequestGate(GateLimits limits = {}) : limits_(limits), all_(limits.all) {}

  /// After Connect, say connected() or failed().
  [[nodiscard]] Verdict ask(const Asker& asker, SteadyTime now);
  void connected(const Asker& asker);
  /// It may ask again a little later.
  void failed(const Asker& asker);
  /// A connected client has left; it may ask again.
  void gone(const Asker& asker) { known_.erase(asker); }

 private:
  struct Source {
    net::TokenBucket allowance;
    std::size_t under_way = 0;
  };

  [[nodiscard]] const std::string& name_of_source(const std::string& address, SteadyTime now);
  void tidy(SteadyTime now);
  Source* finished(const Asker& asker);

  GateLimits limits_;
  net::TokenBucket all_;
  std::set<Asker> known_;                   ///< Under way or connected.
  std::map<Asker, std::string> under_way_;  ///< By the address under which its source is stored.
  std::map<std::string, Source> sources_;   ///< By address; "" for those beyond the limit.
  SteadyTime tidied_{};
};

}  // namespace chorus::vrpn
