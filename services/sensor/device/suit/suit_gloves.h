// Gloves of somebody in a suit: their hands are carried on the suit's wrists and are hands of the
// body in `/frame`.
#pragma once

#include <vector>

#include "common/body/hand_points.h"
#include "common/hand/carried.h"
#include "services/sensor/device/suit/suit_frames.h"

namespace chorus::suit {

class SuitGloves {
 public:
  SuitGloves() = default;
  /// Reads the hands and takes.  Errors name the key and the file.
  [[nodiscard]] static Result<SuitGloves> open(const SuitSettings& settings);

  /// The hands of a body that was made of this pose, `heading` [rad] turned against it; null
  /// without gloves.  A hand whose wrist or elbow is not seen is left out.
  template <class Space>
  [[nodiscard]] HandsPtr hands(const SuitInstant& instant, double heading,
                               const Skeleton<Space>& body) {
    Hands out;
    for (hand::CarriedHand& glove : gloves_) {
      const bool left = glove.side() == hand::Side::Left;
      const Joint& elbow = body[left ? JointId::ElbowLeft : JointId::ElbowRight];
      const Joint& wrist = body[left ? JointId::WristLeft : JointId::WristRight];
      if (!elbow.seen() || !wrist.seen()) continue;
      HandPoints points{
          glove.at(seconds_in(glove, instant), {elbow.position, wrist.position, heading}), {}};
      if (wrist.covariance.known()) points.variance = wrist.covariance.matrix().trace() / 3.0;
      (left ? out.left : out.right) = points;
    }
    return shared(std::move(out));
  }

 private:
  [[nodiscard]] double seconds_in(const hand::CarriedHand& glove, const SuitInstant& instant) const;

  std::vector<hand::CarriedHand> gloves_;
  bool filed_ = false;  ///< The suit is a file: its gloves' takes begin with it.
};

}  // namespace chorus::suit
