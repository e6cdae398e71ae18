// How long a person's bones are, measured while they move, for the description of their skeleton.
//
// Clients build their rest pose from the description and turn its bones as frames say; with the
// bones of an average adult, the limbs of other people would end in the wrong place.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fusion-server/natnet/motive_skeleton.h"

namespace chorus::natnet {

/// Of each bone from its parent's origin at rest [m].
using BoneOffsets = std::array<std::array<double, 3>, kBoneCount>;

/// Those of motive_bones().
[[nodiscard]] BoneOffsets adult_offsets();

/// Of one slot.
class BoneLengths {
 public:
  /// Lengths are the medians of this many frames of a person: five seconds at 30 Hz.
  static constexpr std::size_t kFrames = 150;
  /// A description is changed when a bone differs by more than this from what it says [m].
  static constexpr double kTolerance = 0.005;

  /// False: this person has been measured.
  [[nodiscard]] bool wants(PersonId person) const { return !done_ || person != person_; }
  /// `local`: Coordinates::Local.  Returns the new description once there is one.
  [[nodiscard]] std::optional<BoneOffsets> add(PersonId person, const MotiveSkeleton& local);

 private:
  [[nodiscard]] BoneOffsets measured() const;

  PersonId person_{};
  bool done_ = false;
  std::size_t frames_ = 0;
  /// Of frames in which bone and parent are tracked.
  std::array<std::vector<double>, kBoneCount> lengths_;
  BoneOffsets described_ = adult_offsets();
};

}  // namespace chorus::natnet
