#include "common/http/token_tries.h"

#include <openssl/sha.h>

#include <algorithm>

namespace chorus::http {
namespace {

constexpr std::chrono::seconds kPerTry{1};
constexpr int kAtOnce = 10;
constexpr std::size_t kMaxAddresses = 4096;
// More than kAtOnce, so that the wrong tokens of a guesser do not soon push out those that other
// programs at the same address repeat.
constexpr std::size_t kMarksKept = 16;
const std::string kShared = "others";

}  // namespace

TokenTries::Mark TokenTries::mark_of(std::string_view authorization) {
  Mark mark{};
  static_assert(sizeof(Mark) == SHA256_DIGEST_LENGTH);
  SHA256(reinterpret_cast<const unsigned char*>(authorization.data()), authorization.size(),
         mark.data());
  return mark;
}

const std::string& TokenTries::account(const std::string& address) const {
  return records_.contains(address) || records_.size() < kMaxAddresses ? address : kShared;
}

Duration TokenTries::note_wrong(const std::string& address, std::string_view authorization,
                                Time now) {
  std::erase_if(records_, [now](const auto& entry) { return entry.second.forgiven <= now; });
  Record& record = records_[account(address)];
  const Mark mark = mark_of(authorization);
  if (std::ranges::find(record.wrong, mark) != record.wrong.end()) return Duration{0};
  record.wrong.push_back(mark);
  if (record.wrong.size() > kMarksKept) record.wrong.pop_front();
  // More than this is not owed, so that an address is not slowed for hours after a burst.
  const Time most = now + kAtOnce * kPerTry + kLongestDelay;
  record.forgiven = std::min(std::max(record.forgiven, now) + kPerTry, most);
  return std::max(Duration{0}, Duration(record.forgiven - now - kAtOnce * kPerTry));
}

}  // namespace chorus::http
