#include "common/http/token_tries.h"

#include <algorithm>

namespace chorus::http {
namespace {

constexpr std::chrono::seconds kPerTry{1};
constexpr int kAtOnce = 10;
constexpr std::size_t kMaxAddresses = 4096;
const std::string kShared = "others";

}  // namespace

const std::string& TokenTries::account(const std::string& address) const {
  return forgiven_.contains(address) || forgiven_.size() < kMaxAddresses ? address : kShared;
}

bool TokenTries::may_try(const std::string& address, Time now) const {
  const auto known = forgiven_.find(account(address));
  return known == forgiven_.end() || known->second - now <= (kAtOnce - 1) * kPerTry;
}

void TokenTries::note_wrong(const std::string& address, Time now) {
  std::erase_if(forgiven_, [now](const auto& entry) { return entry.second <= now; });
  Time& forgiven = forgiven_[account(address)];
  forgiven = std::max(forgiven, now) + kPerTry;
}

}  // namespace chorus::http
