// What an output protocol sends: fused bodies in numbered slots, every joint with a full pose.
//
// World space, metres, radians, seconds; encoders go through axes.h.  A value: encoders are pure
// functions of it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "fusion-server/flow.h"

namespace chorus::outlet {

/// Slots a configuration may ask for.
inline constexpr int kMaxSlots = 20;

struct TrackerJoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  /// Always a unit quaternion: a joint without an orientation takes that of the next joint towards
  /// the pelvis that has one; if there is none, the identity.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< World axes [rad/s]
  /// False: its place is unknown (or absurdly far, as in /frame); do not send a pose.
  bool tracked = false;
};

struct TrackerBody {
  std::size_t slot = 0;  ///< 0 .. slots - 1; as FusedBody has it.
  PersonId person;
  std::array<TrackerJoint, kJointCount> joints;

  [[nodiscard]] const TrackerJoint& operator[](JointId id) const { return joints[index_of(id)]; }
};

struct TrackerFrame {
  std::uint64_t sequence = 0;  ///< Protocols with 32 bits send it modulo 2^32.
  Timestamp instant;      ///< What the poses are for: the fused instant, or later if predicted.
  std::size_t slots = 0;  ///< At most this many persons.
  std::vector<TrackerBody> bodies;  ///< In order of slot.
};

/// The joint itself when it is tracked, else the next tracked one towards the pelvis; the pelvis,
/// tracked or not, if there is none.  Where every joint must have a place, unseen limbs are put
/// there.
[[nodiscard]] JointId nearest_tracked(const TrackerBody& body, JointId joint);

/// The body in a slot, or nullptr.
[[nodiscard]] const TrackerBody* in_slot(const TrackerFrame& frame, std::size_t slot);

/// Computes the velocities of joints, snapshot after snapshot.
class TrackerState {
 public:
  explicit TrackerState(std::size_t slots) : slots_(slots) {}

  /// Persons without a slot, and those beyond the last slot, are left out.  A repeated or older
  /// instant gives zero velocities.
  /// gives zero velocities.
  [[nodiscard]] TrackerFrame advance(const Snapshot& snapshot);

 private:
  std::size_t slots_;
  std::map<PersonId, TrackerBody> before_;
  Timestamp instant_{};
};

/// The same frame as it will be at `then`, at constant velocity.  Limited to 50 ms (limbs gain more
/// error than they save beyond); an earlier time changes nothing.
[[nodiscard]] TrackerFrame predicted(TrackerFrame frame, Timestamp then);

}  // namespace chorus::outlet
