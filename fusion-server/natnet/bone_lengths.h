// How long a person's bones are, measured while it moves: what its skeleton's description says.
//
// Clients build their rest pose from the description and turn its bones as frames say; with the
// bones of an average adult a limb of somebody else ends in the wrong place.
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
  /// Frames of one person that its lengths are the medians of: five seconds at 30 Hz.
  static constexpr std::size_t kFrames = 150;
  /// A description is changed when a bone is longer or shorter than it says by more than this [m].
  static constexpr double kTolerance = 0.005;

  /// False: this person has been measured.
  [[nodiscard]] bool wants(PersonId person) const { return !done_ || person != person_; }
  /// `local`: Coordinates::Local.  The new description, once there is one.
  [[nodiscard]] std::optional<BoneOffsets> add(PersonId person, const MotiveSkeleton& local);

 private:
  [[nodiscard]] BoneOffsets measured() const;

  PersonId person_{};
  bool done_ = false;
  std::size_t frames_ = 0;
  std::array<std::vector<double>, kBoneCount> lengths_;  ///< Where bone and parent are tracked.
  BoneOffsets described_ = adult_offsets();
};

}  // namespace chorus::natnet
