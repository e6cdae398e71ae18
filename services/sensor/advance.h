// Whether the captures of one kind (frames, or orientations) go on as they should.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/time/timestamp.h"

namespace chorus::sensor_service {

/// A time that goes back by more than a second, or by less if the next capture continues from
/// there, means that the clock was set; from then on times are compared with the new one.
class Advance {
 public:
  /// Why a capture with this number and time cannot follow the one before it; empty if it can.
  [[nodiscard]] std::string objection(std::uint64_t sequence, Timestamp captured) const;

  /// Takes it.  Returns how many numbers are missing before it.
  std::uint64_t take(std::uint64_t sequence, Timestamp captured);
  void refuse(Timestamp captured) { refused_ = captured; }

  [[nodiscard]] bool begun() const { return latest_.has_value(); }

 private:
  struct Stamp {
    std::uint64_t sequence = 0;
    Timestamp captured;
  };
  std::optional<Stamp> latest_;
  std::optional<Timestamp> refused_;  ///< Time of the previous capture, if that was refused.
};

}  // namespace chorus::sensor_service
