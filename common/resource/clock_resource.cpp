#include "common/resource/clock_resource.h"

#include "common/resource/flat_reader.h"
#include "common/resource/frame_facts.h"

namespace chorus::resource {
namespace {

Duration duration_of(const Properties& properties, std::string_view key) {
  const auto found = properties.find(key);
  if (found == properties.end()) return Duration{0};
  return Duration{parse_signed(found->second).value_or(0)};
}

}  // namespace

Node clock_node(const ClockState& clock) {
  constexpr int kPpmDigits = 4;
  return {"",
          {"Clock"},
          {{"now", clock.now},
           {"nowNanoseconds", to_unix_ns(clock.now)},
           {"synchronised", clock.ntp.synchronised},
           {"offsetNanoseconds", std::int64_t{clock.ntp.offset.count()}},
           {"maxErrorNanoseconds", std::int64_t{clock.ntp.max_error.count()}},
           {"estimatedErrorNanoseconds", std::int64_t{clock.ntp.est_error.count()}},
           {"frequencyPpm", Decimal{clock.ntp.frequency_ppm, kPpmDigits}}}};
}

Result<ClockState> read_clock(std::string_view bytes, Format format) {
  const auto properties = read_properties(bytes, format, "Clock");
  if (!properties) return pass(properties);
  const auto now = properties->find("nowNanoseconds");
  if (now == properties->end())
    return fail(ErrorCode::Malformed, "ch:nowNanoseconds", "is missing");
  const auto ns = parse_signed(now->second);
  if (!ns || *ns < 0)
    return fail(ErrorCode::Malformed, "ch:nowNanoseconds", "is no time since 1970");
  ClockState clock;
  clock.now = from_unix_ns(*ns);
  const auto synchronised = properties->find("synchronised");
  clock.ntp.synchronised = synchronised != properties->end() && synchronised->second == "true";
  clock.ntp.offset = duration_of(*properties, "offsetNanoseconds");
  clock.ntp.max_error = duration_of(*properties, "maxErrorNanoseconds");
  clock.ntp.est_error = duration_of(*properties, "estimatedErrorNanoseconds");
  clock.ntp.frequency_ppm = number_of(*properties, "frequencyPpm").value_or(0.0);
  return clock;
}

}  // namespace chorus::resource
