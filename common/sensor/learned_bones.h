// The lengths of a person's bones, learned over many images, although a model guesses the person's
// shape from each image separately.
#pragma once

#include <array>

#include "common/body/bones.h"

namespace chorus {

/// A running mean with bounded steps for each bone, so that a wrong guess hardly counts.  Left and
/// right learn apart: models err differently on the side that is turned away, and one length for
/// both made depths worse.  What the model has wrong about a person all the time stays wrong.
class LearnedBones {
 public:
  /// Learns from the shape of one image.
  void learn(const Skeleton<SensorSpace>& shape);
  /// The shape with bones of the learned lengths, in the directions that they have.  Bones of
  /// which one end is missing, or that were never seen, stay as they are.
  [[nodiscard]] Skeleton<SensorSpace> applied(const Skeleton<SensorSpace>& shape) const;

 private:
  struct Learned {
    double length = 0.0;  ///< [m]
    double spread = 0.0;  ///< Mean absolute deviation [m].
    double count = 0.0;
  };
  std::array<Learned, kJointCount> bones_;  ///< By the joint at the outer end.
};

}  // namespace chorus
