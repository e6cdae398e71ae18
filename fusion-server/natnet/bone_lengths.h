// Measures the bone lengths of a moving person, for the description of the person's skeleton.
//
// Clients build their rest pose from the description, and rotate its bones as the frames say.  With
// the bones of an average adult, other people's limbs would end in the wrong place.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fusion-server/natnet/motive_skeleton.h"

namespace chorus::natnet {

/// Offset of each bone from its parent's origin at rest [m].
using BoneOffsets = std::array<std::array<double, 3>, kBoneCount>;

/// The offsets that motive_bones() states.
[[nodiscard]] BoneOffsets adult_offsets();

/// Measures the people in one slot, one after the other.
class BoneLengths {
 public:
  /// Lengths are medians over this many frames of a person, five seconds at 30 Hz.
  static constexpr std::size_t kFrames = 150;
  /// The description is updated when a bone's length differs from it by more than this [m].
  static constexpr double kTolerance = 0.005;

  /// False if this is the person who was measured last.
  [[nodiscard]] bool wants(PersonId person) const { return !done_ || person != person_; }
  /// Adds a frame; `local` uses Coordinates::Local.  Returns a new description when it is complete
  /// and differs from the last one.
  [[nodiscard]] std::optional<BoneOffsets> add(PersonId person, const MotiveSkeleton& local);

 private:
  [[nodiscard]] BoneOffsets measured() const;

  PersonId person_{};
  bool done_ = false;
  std::size_t frames_ = 0;
  /// Measured lengths of each bone, from frames in which the bone and its parent are tracked.
  std::array<std::vector<double>, kBoneCount> lengths_;
  BoneOffsets described_ = adult_offsets();
};

}  // namespace chorus::natnet
