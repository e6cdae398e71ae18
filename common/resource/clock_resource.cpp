#include "common/resource/clock_resource.h"

namespace chorus::resource {
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

}  // namespace chorus::resource
