// Lets a change of the sensors' places reach the output gradually.
//
// The difference between the bodies according to the old places and those according to the new ones
// is added to the bodies and fades to zero, so that nothing that follows a person jumps.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "common/time/timestamp.h"
#include "fusion-server/flow/fused_body.h"

namespace chorus::core {

class CrossFade {
 public:
  /// Takes the same people at one instant, according to the old places and to the new ones. A
  /// person with a joint that is displaced by more than half a metre is not faded: the world was
  /// moved, or it is somebody else.
  void begin(const std::vector<FusedBody>& before, const std::vector<FusedBody>& now, Timestamp at);

  /// Adds what is left of the differences.
  void apply(std::vector<FusedBody>& bodies, Timestamp at) const;

  void stop() { offsets_.clear(); }

 private:
  using Offsets = std::array<Eigen::Vector3d, kJointCount>;

  Timestamp begun_;
  std::map<PersonId, Offsets> offsets_;
};

}  // namespace chorus::core
