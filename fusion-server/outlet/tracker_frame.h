// What an output protocol sends: fused bodies in numbered slots, each joint with a full pose.
//
// World space, metres, radians, seconds; encoders convert with axes.h.  A plain value: encoders are
// pure functions of it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/workplace/prop_board.h"
#include "fusion-server/flow/snapshot.h"

namespace chorus::outlet {

/// Largest number of slots that may be configured.
inline constexpr int kMaxSlots = 20;

struct TrackerJoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  /// Always a unit quaternion.  A joint without an orientation has that of the nearest joint
  /// towards the pelvis that has one; if there is none, the identity.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  /// A sensor states the orientation of this very joint.
  bool oriented = false;
  /// A sensor on the limb measured how it is turned about itself; `orientation` is then the limb's
  /// (common/evaluation/limb_frame.h): +y along the bone, +x the axis of the elbow or knee.
  bool twist_measured = false;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< World axes [rad/s]
  /// False: the position is unknown, or too far away to be plausible, as in /frame; do not send a
  /// pose.
  bool tracked = false;
};

struct TrackerBody {
  std::size_t slot = 0;  ///< From 0 to slots - 1; as in FusedBody::slot.
  PersonId person;
  std::array<TrackerJoint, kJointCount> joints;

  [[nodiscard]] const TrackerJoint& operator[](JointId id) const { return joints[index_of(id)]; }
};

/// Something that a person holds, as a rigid body of its own.
struct TrackerProp {
  std::string name;
  std::size_t slot = 0;  ///< Of the person who holds it, if it is tracked.
  TrackerJoint pose;     ///< Not tracked: nobody who is sent holds it.
};

struct TrackerFrame {
  std::uint64_t sequence = 0;  ///< Protocols with 32-bit counters send it modulo 2^32.
  Timestamp instant;           ///< Time of the poses: the fused instant, or later if predicted.
  std::size_t slots = 0;       ///< Largest number of persons that are sent.
  std::vector<TrackerBody> bodies;  ///< Ordered by slot.
  std::vector<TrackerProp> props;   ///< All that there are, in the order of the configuration.
};

/// The joint itself if it is tracked, otherwise the nearest tracked joint towards the pelvis; if
/// there is none, the pelvis, tracked or not.  Protocols in which every joint must have a position
/// place unseen limbs there.
[[nodiscard]] JointId nearest_tracked(const TrackerBody& body, JointId joint);

/// The body in this slot; null if there is none.
[[nodiscard]] const TrackerBody* in_slot(const TrackerFrame& frame, std::size_t slot);

/// Completes snapshots by velocities: those that the method of fusion states (FusedBody::motion),
/// and otherwise, as for all orientations, those from snapshot to snapshot.
class TrackerState {
 public:
  explicit TrackerState(std::size_t slots,
                        std::shared_ptr<const workplace::PropBoard> board = nullptr);

  /// The next frame.  People without a slot, or in a slot too high, are left out.  Velocities from
  /// snapshot to snapshot are zero unless the instant is later than that of the last snapshot, by
  /// at most 250 ms.
  [[nodiscard]] TrackerFrame advance(const Snapshot& snapshot);

 private:
  void add_props(const Snapshot& snapshot, double step, TrackerFrame& frame);

  std::size_t slots_;
  std::shared_ptr<const workplace::PropBoard> board_;
  workplace::HeldProps held_;
  std::vector<TrackerProp> props_before_;
  std::map<PersonId, TrackerBody> before_;
  Timestamp instant_{};
};

/// The frame of `snapshot`, predicted for `then`, by at most 50 ms: bodies whose method states
/// velocities by fusion::predicted(), all other poses at constant velocity (farther ahead, their
/// limbs gain more error than they lose).  If `then` is earlier, the frame is unchanged.
[[nodiscard]] TrackerFrame predicted(TrackerFrame frame, const Snapshot& snapshot, Timestamp then);

}  // namespace chorus::outlet
