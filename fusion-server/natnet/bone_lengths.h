// Measures the bone lengths of a moving person, for the description of their skeleton.
//
// Clients build their rest pose from the description and rotate its bones as frames say; with the
// bones of an average adult, the limbs of other people would end in the wrong place.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fusion-server/natnet/motive_skeleton.h"

namespace chorus::natnet {

/// Offset of each bone from its parent's origin at rest [m].
using BoneOffsets = std::array<std::array<double, 3>, kBoneCount>;

/// The offsets in motive_bones().
[[nodiscard]] BoneOffsets adult_offsets();

/// The measurement for one slot.
class BoneLengths {
 public:
  /// Lengths are medians over this many frames of a person: five seconds at 30 Hz.
  static constexpr std::size_t kFrames = 150;
  /// The description is updated when a bone differs from it by more than this [m].
  static constexpr double kTolerance = 0.005;

  /// False: this person has already been measured.
  [[nodiscard]] bool wants(PersonId person) const { return !done_ || person != person_; }
  /// `local` uses Coordinates::Local.  Returns the new description once it is complete.
  [[nodiscard]] std::optional<BoneOffsets> add(PersonId person, const MotiveSkeleton& local);

 private:
  [[nodiscard]] BoneOffsets measured() const;

  PersonId person_{};
  bool done_ = false;
  std::size_t frames_ = 0;
  /// Lengths from frames in which the bone and its parent are tracked.
  std::array<std::vector<double>, kBoneCount> lengths_;
  BoneOffsets described_ = adult_offsets();
};

}  // namespace chorus::natnet
