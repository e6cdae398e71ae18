// Decides which datagrams make us connect to their sender: few of them, and only one per client.
//
// Sender addresses can be forged, so connections to them are limited in number and rate: per
// address, so that a flood from one host leaves room for others, and in total.  A failed connection
// costs its address more.  VRPN's clients ask again every two seconds until they are answered.  A
// flood with very many forged addresses can still use up the total; the protocol offers no way to
// detect this.
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
  /// Largest number of connections being established at the same time.
  std::size_t most_under_way = 32;
  net::Allowance all{32.0, 64.0};
  std::size_t most_of_source = 8;  ///< The same as most_under_way, for one address.
  net::Allowance source{16.0, 32.0};
  double failure = 4.0;  ///< Extra cost to an address when a connection fails.
  /// Number of addresses with an allowance of their own; all others share one allowance.
  std::size_t most_sources = 256;
};

/// The client that asks, and the port at which it wants to be connected.
struct Asker {
  std::string address;
  std::uint16_t port = 0;

  auto operator<=>(const Asker&) const = default;
};

class RequestGate {
 public:
  enum class Verdict { Connect, Repeated, Refused };

  explicit RequestGate(GateLimits limits = {}) : limits_(limits), all_(limits.all) {}

  /// After Verdict::Connect, call connected() or failed().
  [[nodiscard]] Verdict ask(const Asker& asker, SteadyTime now);
  void connected(const Asker& asker);
  /// Call this when the connection has failed; the client may ask again a little later.
  void failed(const Asker& asker);
  /// Call this when a connected client has left; it may ask again.
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
  std::set<Asker> known_;  ///< Clients that are connected or being connected.
  /// For each client being connected, the key of its source in `sources_`.
  std::map<Asker, std::string> under_way_;
  std::map<std::string, Source> sources_;  ///< By address; "" for all addresses beyond the limit.
  SteadyTime tidied_{};
};

}  // namespace chorus::vrpn
