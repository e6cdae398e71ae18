// How many events a second each address may cause: one bucket an address, bounded in number.
#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>

#include "common/net/token_bucket.h"

namespace chorus::net {

/// Used on one thread.  While kMostAddresses have not got their whole allowance back, all further
/// ones share one.
class AddressAllowance {
 public:
  static constexpr std::size_t kMostAddresses = 4096;

  explicit AddressAllowance(Allowance each) : each_(each), shared_(each) {}

  /// True if the address may have one more event now.
  [[nodiscard]] bool take(const std::string& address, SteadyTime now) {
    const auto known = of_.find(address);
    if (known != of_.end()) return known->second.take(1.0, now);
    if (of_.size() >= kMostAddresses)
      std::erase_if(of_, [now](const auto& entry) { return entry.second.full(now); });
    if (of_.size() >= kMostAddresses) return shared_.take(1.0, now);
    return of_.emplace(address, TokenBucket(each_)).first->second.take(1.0, now);
  }

 private:
  Allowance each_;
  TokenBucket shared_;
  std::unordered_map<std::string, TokenBucket> of_;
};

}  // namespace chorus::net
