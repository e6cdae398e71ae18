// Rotations of a maker's skeleton, as they come, put together into readings.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/inertial/inertial_frame.h"

namespace chorus::inertial {

/// Instants that wait for a reader who asks seldom; of a flood the oldest are lost.
inline constexpr std::size_t kMostWaiting = 100;

/// A segment as the tables of makers' skeletons have it.
struct SegmentRow {
  std::string_view name;
  int parent;  ///< The row of it; -1: none.
  std::optional<Limb> limb;
};

struct Segment {
  std::string name;
  int parent = -1;                ///< Comes before it; -1: turns in the world.
  std::optional<Limb> limb = {};  ///< Segments without one are parts of the chain alone.
};

/// The quaternion that was sent, of unit length; Malformed, naming the segment, if it is none.
[[nodiscard]] Result<Eigen::Quaterniond> sent_rotation(std::string_view segment,
                                                       const Eigen::Quaterniond& sent);

/// A rotation of Unity's world (left-handed, +y up, +z ahead) in ours, with z reversed.
[[nodiscard]] Eigen::Quaterniond from_unity(const Eigen::Quaterniond& in_unity);

class SegmentPoses {
 public:
  SegmentPoses() = default;
  explicit SegmentPoses(std::vector<Segment> segments);

  /// The segment's rotation in its parent, or in the world.  Segments that were never turned have
  /// that of their parent.  A segment that is turned again at another time, before instant() was
  /// called, begins another instant: nothing is lost of a source that is faster than it is asked.
  void turn(std::size_t segment, const Eigen::Quaterniond& in_parent, Timestamp now);
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
  [[nodiscard]] std::size_t size() const noexcept { return segments_.size(); }
  /// Another hierarchy of the same segments.
  void set_parent(std::size_t segment, int parent) { segments_[segment].parent = parent; }

  /// Readings of the limbs that were turned since the last call, one instant after the other; none
  /// if no limb was.  Only the last one is of `now`; those before are of their last reading's time.
  [[nodiscard]] std::optional<InertialFrame> instant(Timestamp now);

 private:
  struct State {
    Eigen::Quaterniond in_parent = Eigen::Quaterniond::Identity();
    std::optional<Timestamp> fresh = {};
  };

  [[nodiscard]] std::optional<InertialFrame> gather(Timestamp now);

  std::vector<Segment> segments_;
  std::vector<State> states_;
  std::deque<InertialFrame> waiting_;  ///< Instants that are complete.
  Timestamp turned_{};                 ///< When a segment was last turned.
  std::uint64_t instants_ = 0;
};

}  // namespace chorus::inertial
