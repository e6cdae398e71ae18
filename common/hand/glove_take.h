// How a hand is held over time, as a glove's program records it: a BVH file over the skeleton that
// `chorus scan` wrote (Madaras et al., 4.2).
//
// The file's world is +y up.  The hand may hang from an arm or a whole body: the turns of all its
// parents count.  Its place in the file does not.
#pragma once

#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/hand/bvh.h"

namespace chorus::hand {

struct GloveTake {
  Side side = Side::Right;
  double rate_hz = 60.0;
  bool alone = false;  ///< The hand is the file's root: no arm says where its world's ahead is.
  std::vector<Pose> poses;  ///< Never empty; wrist: where the file puts it [m].

  [[nodiscard]] double length_s() const { return static_cast<double>(poses.size()) / rate_hz; }
};

/// `side`: which hand of a body with two.  NotFound without a joint LeftHand or RightHand, with or
/// without the prefix "mixamorig:"; fingers that the file lacks stay in their rest pose.
[[nodiscard]] Result<GloveTake> read_glove_take(std::string_view bvh, std::string_view origin,
                                                Side side);

/// The pose at that time since the take's beginning, between the two nearest; the first or the last
/// one beyond its ends.
[[nodiscard]] Pose pose_at(const GloveTake& take, double seconds);

}  // namespace chorus::hand
