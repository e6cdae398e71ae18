// The lengths of a person's bones, learned over many pictures, although a model guesses the
// person's shape from each picture separately.
#pragma once

#include <array>

#include "common/body/bones.h"

namespace chorus {

/// A running mean with bounded steps for each bone, so that a wrong guess hardly counts.  Left and
/// right are learned separately, because models err differently on the side that is turned away,
/// and one length for both made depths worse.  Errors that the model always makes about a person
/// remain.
class LearnedBones {
 public:
  /// Learns from the shape in one picture.
  void learn(const Skeleton<SensorSpace>& shape);
  /// Returns the shape with its bones scaled to the learned lengths; their directions stay.  Bones
  /// of which one end is missing, or that were never seen, keep their lengths.
  [[nodiscard]] Skeleton<SensorSpace> applied(const Skeleton<SensorSpace>& shape) const;

 private:
  struct Learned {
    double length = 0.0;  ///< [m]
    double spread = 0.0;  ///< Mean absolute deviation [m].
    double count = 0.0;
  };
  std::array<Learned, kJointCount> bones_;  ///< Indexed by the joint at the bone's outer end.
};

}  // namespace chorus
