// Keeps a list of the frames that a stream left out; they are fetched from /frames/{seq} one by
// one.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/base/duration.h"

namespace chorus::client {

class Backfill {
 public:
  /// Call this for every frame that came by stream, in order of arrival.
  void saw(std::uint64_t sequence, Duration now);

  /// The oldest missing frame that is still worth a request; it is then taken off the list.
  [[nodiscard]] std::optional<std::uint64_t> next(Duration now);

  /// Call this with the outcome of the request.  A sensor that does not keep frames is soon no
  /// longer asked.
  void answered(bool there);

  [[nodiscard]] bool empty() const noexcept { return missing_.empty(); }

  /// Call this for a new stream, which may be of another run of the sensor.
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

}  // namespace chorus::client
