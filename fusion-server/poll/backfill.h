// Keeps track of frames that a stream left out, to be fetched from /frames/{seq} one by one.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/base/duration.h"

namespace chorus::poll {

class Backfill {
 public:
  /// To be called for every frame that came by stream, in order of arrival.
  void saw(std::uint64_t sequence, Duration now);

  /// The oldest gap still worth a request; it then counts as being fetched.
  [[nodiscard]] std::optional<std::uint64_t> next(Duration now);

  /// Takes the outcome of the request.  A sensor that keeps no frames is soon asked no more.
  void answered(bool there);

  [[nodiscard]] bool empty() const noexcept { return missing_.empty(); }

  /// To be called for a new stream, perhaps from another run of the sensor.
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
