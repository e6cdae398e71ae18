// Reads any text as a Chorus-Clock header, and any four stamps as an exchange: the result is two
// times or nothing, and an estimate whose uncertainty is never negative, whatever the stamps are.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "common/time/clock_estimate.h"

namespace {

using namespace chorus;

constexpr Timestamp kEarliest = from_unix_ns(1'000'000'000'000'000'000);
constexpr Timestamp kLatest = from_unix_ns(9'000'000'000'000'000'000);

void require(bool holds) {
  if (!holds) std::abort();
}

/// A header that was read can be written and read again.
void check_header(std::string_view text) {
  const auto stamps = parse_server_stamps(text);
  if (!stamps) return;
  const std::string again = std::to_string(to_unix_ns(stamps->receipt)) + " " +
                            std::to_string(to_unix_ns(stamps->sending));
  const auto same = parse_server_stamps(again);
  require(same && same->receipt == stamps->receipt && same->sending == stamps->sending);
}

/// Reads the bytes as successive exchanges of four stamps.
void check_filter(std::string_view bytes) {
  constexpr std::size_t kStamps = 4;
  ClockFilter filter;
  Timestamp newest{};
  while (bytes.size() >= kStamps * sizeof(std::int64_t)) {
    std::int64_t stamps[kStamps];
    std::memcpy(stamps, bytes.data(), sizeof stamps);
    bytes.remove_prefix(sizeof stamps);
    newest = from_unix_ns(stamps[3]);
    filter.add({from_unix_ns(stamps[0]), from_unix_ns(stamps[1]), from_unix_ns(stamps[2]), newest});
    if (newest < kEarliest || newest > kLatest) continue;  // our own clock is not under attack
    const auto estimate = filter.at(newest);
    if (estimate) require(estimate->uncertainty >= Duration::zero());
    (void)correction(estimate);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  check_header(text.substr(0, text.find('\n')));
  check_filter(text);
  return 0;
}
