// How much each sensor counts in a fused joint: a fraction per sensor, all of which sum to one.
//
// They are kept in hundredths, as on the wire, so that they sum to one exactly and a body of 25
// joints needs no memory of its own for them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/sensor/limits.h"

namespace chorus {

class Shares {
 public:
  Shares() = default;  ///< Not known, or nobody's.

  [[nodiscard]] bool known() const { return known_; }
  /// In [0, 1]; zero for every sensor if the shares are not known.
  [[nodiscard]] double of(std::size_t sensor) const { return hundredths_[sensor] / kWhole; }

  /// Per sensor, in hundredths that sum to kHundredths.
  static constexpr unsigned kHundredths = 100;
  using Hundredths = std::array<std::uint8_t, kMaxSensors>;
  explicit Shares(const Hundredths& hundredths) : hundredths_(hundredths), known_(true) {}

  bool operator==(const Shares&) const = default;

 private:
  static constexpr double kWhole = kHundredths;

  Hundredths hundredths_{};
  bool known_ = false;
};

/// Collects the weights of sensors; shares are in proportion to them.
class ShareTally {
 public:
  /// `sensor` is a sensor's bit.  0 (a sensor without a bit) and weights that are not positive and
  /// finite count for nothing.
  void add(std::uint64_t sensor, double weight);

  /// Unknown when nothing was counted.  Each differs from the exact fraction by less than 0.01.
  [[nodiscard]] Shares shares() const;

 private:
  std::array<double, kMaxSensors> weights_{};
  std::uint64_t sensors_ = 0;
};

}  // namespace chorus
