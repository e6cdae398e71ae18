// Which frames a stream has left out, to be fetched from /frames/{seq} one by one.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/base/duration.h"

namespace chorus::poll {

class Backfill {
 public:
  /// A frame that came by stream, in the order of arrival.
  void saw(std::uint64_t sequence, Duration now);

  /// The oldest gap that is still worth a request; from now on it counts as being fetched.
  [[nodiscard]] std::optional<std::uint64_t> next(Duration now);

  /// The outcome of the request.  A sensor that keeps no frames is soon not asked any more.
  void answered(bool there);

  [[nodiscard]] bool empty() const noexcept { return missing_.empty(); }

  /// A new stream, perhaps of another run of the sensor.
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
