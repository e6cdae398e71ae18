// What association remembers about people from one instant to the next.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/body/bones.h"
#include "fusion-server/associate/sight_field.h"
#include "fusion-server/associate/tracklets.h"

namespace chorus::associate {

/// A sensor's body at an instant, kept to compute motion from.
struct Footprint {
  SensorId sensor;
  BodyId body;
  std::array<std::optional<Eigen::Vector3d>, kCoreJoints.size()> core;  ///< World [m].
};

/// How far the sensors agree that there is somebody (existence.h).
struct Belief {
  double balance = 0.0;  ///< Integral of what spoke for and against it, within limits [s].
  bool moved = false;    ///< True once the person has left the place where they appeared.
  std::optional<Eigen::Vector3d> last = {};  ///< Track::core at the last instant with sights.
  Duration waited{0};  ///< How long it has been seen while only moving would have decided.
};

/// A plane that reflects, in world space: all x with normal . x = offset.
struct Mirror {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< Of length 1; either side.
  double offset = 0.0;                                ///< [m]
};
using Mirrors = std::vector<Mirror>;

/// Whose image in a mirror a track may be (mirrors.h).
struct Image {
  PersonId of;                                     ///< The person whom it resembles.
  Mirror mirror = {};                              ///< The plane in which it does.
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< Where `way` was counted to, world [m].
  double way = 0.0;     ///< How far the person has gone while the image followed [m].
  double unlike = 0.0;  ///< For how long it has resembled nobody [s].
  bool like = false;    ///< True if it resembles them at this instant.
  bool sure = false;    ///< True once it is an image and not a second person.
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
  bool admitted = false;                               ///< True while the track may be published.
  Eigen::Vector3d appeared = Eigen::Vector3d::Zero();  ///< `core` at the first instant.
  Belief belief = {};
  Image image = {};
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
  std::vector<Track> people;
  std::vector<Missing> missing = {};  ///< In the order in which they left.
  Repeatability repeatability = {};
  SightFields fields = {};  ///< Where each sensor sees people.
  Mirrors mirrors = {};
  bool floor_seen = false;  ///< True once somebody whom several sensors saw stood on the floor.
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
