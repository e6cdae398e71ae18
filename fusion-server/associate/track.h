// What association remembers about people from one instant to the next.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/body/bones.h"
#include "fusion-server/associate/tracklets.h"

namespace chorus::associate {

/// A sensor's body at an instant, kept to compute motion from.
struct Footprint {
  SensorId sensor;
  BodyId body;
  std::array<std::optional<Eigen::Vector3d>, kCoreJoints.size()> core;  ///< World [m].
};

/// What is remembered of one person.
struct Track {
  PersonId id;
  Timestamp found;  ///< First instant at which views located the person.
  Timestamp seen;   ///< Last instant at which views showed the person.
  /// Last instant at which views located the person; a single ray body does not.
  Timestamp placed;
  int hits = 0;  ///< Number of instants at which views located the person.
  Eigen::Vector3d core = Eigen::Vector3d::Zero();      ///< Mean of the core joints, world [m].
  PlanError error = PlanError::Zero();                 ///< Of `core`, as far as sensors state it.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
  /// The bodies that sensors showed when the person was last placed.
  std::vector<Footprint> footprints = {};
  /// For how many instants in a row another track, which a merger would keep, has been on the same
  /// spot without a sensor that sees both.
  int shadowed = 0;
  /// Positions of the joints when the person was last seen; empty if no view then was a ray body.
  Located joints;
  bool admitted = false;  ///< True if the track may be published; it stays true.
  Eigen::Vector3d appeared = Eigen::Vector3d::Zero();  ///< `core` at the first instant.
  bool moved = false;  ///< True once the person has left the place where they appeared.
  /// True once a sensor has looked at the person's place without seeing the person.
  bool doubted = false;
  Duration alone{0};  ///< How long the doubted person has been seen; see Admission::judge().
  /// How long sensors have seen through the place where the person is expected.
  Duration through{0};
  Tracklets build = {};  ///< What is known of the person's build.
  Build usual = {};      ///< The same, without what may be somebody else's.
  /// How unlike the wearer of this person's inertial sensors the views are, 0 to 1, in the mean of
  /// half a second (worn_likeness.h); 0: nobody knows of any sensor.
  double unlike = 0.0;
  /// True once the id is given: the person is new, or was recognised.
  bool named = false;
  /// True while the person now in view is probably not the one who has the id.
  bool withheld = false;
  std::optional<Timestamp> published = {};  ///< When last published under this id.
};

/// A person who left, or who was not found for too long, and whose build is known.
struct Missing {
  PersonId id;
  Timestamp seen;  ///< When last seen.
  Build build;
};

struct Tracks {
  std::uint64_t next_id = 1;
  Timestamp instant;  ///< The last instant that group() has processed.
  Timestamp began;    ///< The first one.
  std::vector<Track> people;
  std::vector<Missing> missing = {};  ///< In the order in which they left.
  Repeatability repeatability = {};
};

/// A track while its instant is being processed.
struct Candidate {
  Track track;
  Eigen::Vector3d predicted = Eigen::Vector3d::Zero();  ///< Where the core is expected [m].
  double gate = 0.0;  ///< How far from there the person is looked for [m].
  std::vector<PlacedView> sights = {};
  std::optional<Doubt> doubt = {};      ///< That the person changed, as recognise() found it.
  std::span<const WornLimb> worn = {};  ///< What inertial sensors on the person say now.
};

}  // namespace chorus::associate
