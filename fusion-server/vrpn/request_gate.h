// Which datagrams make us connect to somebody: few, and each client once.  Pure.
//
// Anybody can send a datagram, and in anybody's name, so connecting back is limited in number at a
// time and in rate: of each address, so that one host's flood leaves the others theirs, and of all
// together.  Where nobody answers costs the address more.  VRPN's clients ask again every two
// seconds until they are heard.  A flood in the names of very many addresses can still use up what
// all together have; the protocol has no means to tell.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "fusion-server/outlet/token_bucket.h"

namespace chorus::vrpn {

struct GateLimits {
  std::size_t most_under_way = 32;  ///< Connections being made.
  outlet::Allowance all{32.0, 64.0};
  std::size_t most_of_source = 8;  ///< Being made to one address.
  outlet::Allowance source{16.0, 32.0};
  double failure = 4.0;            ///< What one that fails costs its address besides.
  std::size_t most_sources = 256;  ///< Addresses kept apart; those beyond share one allowance.
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
  [[nodiscard]] Verdict ask(const Asker& asker, outlet::SteadyTime now);
  void connected(const Asker& asker);
  /// It may ask again, a little later.
  void failed(const Asker& asker);
  /// A connected one has left; it may ask again.
  void gone(const Asker& asker) { known_.erase(asker); }

 private:
  struct Source {
    outlet::TokenBucket allowance;
    std::size_t under_way = 0;
  };

  [[nodiscard]] const std::string& name_of_source(const std::string& address,
                                                  outlet::SteadyTime now);
  void tidy(outlet::SteadyTime now);
  Source* finished(const Asker& asker);

  GateLimits limits_;
  outlet::TokenBucket all_;
  std::set<Asker> known_;                   ///< Under way or connected.
  std::map<Asker, std::string> under_way_;  ///< By which name its source is found.
  std::map<std::string, Source> sources_;   ///< By address; "" for those beyond the limit.
  outlet::SteadyTime tidied_{};
};

}  // namespace chorus::vrpn
