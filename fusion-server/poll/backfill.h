// Which frames a stream has left out, to be fetched from /frames/{seq} one by one.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/base/duration.h"

namespace chorus::poll {

class Backfill {
 public:
  /// A frame that has come by stream, in the order of coming.
  void saw(std::uint64_t sequence, Duration now);

  /// The oldest gap that is still worth a request, and no longer a gap: it is being fetched.
  [[nodiscard]] std::optional<std::uint64_t> next(Duration now);

  /// What became of the request.  A sensor that keeps no frames is not asked for ever.
  void answered(bool there);

  [[nodiscard]] bool empty() const noexcept { return missing_.empty(); }

  /// Another stream, perhaps of another run of the sensor.
  void restart();

 private:
  struct Gap {
    std::uint64_t sequence = 0;
    Duration noticed{0};
  };

  std::optional<std::uint64_t> last_;
  std::deque<Gap> missing_;
  int in_vain_ = 0;
};

}  // namespace chorus::poll
