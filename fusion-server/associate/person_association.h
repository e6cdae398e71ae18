// Which bodies of which sensors are the same person, now and over time.
//
// Per instant: predicted tracks are matched with world bodies by the horizontal distance of their
// core joints (people do not stand on one another, and an occluded hip must not lift a body away
// from its track), one-to-one per sensor; bodies left over are clustered across sensors into new
// people.  Two tracks on one spot that never share a sensor are one person and become the older
// one.  A person whom only one sensor sees where others look is not published at once
// (admission.h).  Bodies of cameras without depth, whose joints are rays, are matched by how far
// their rays pass the joints of a track (ray_matching.h); a single one founds nobody, and does not
// keep anybody alive.  Ids are never reused.
#pragma once

#include <cstdint>
#include <vector>

#include "common/base/units.h"
#include "fusion-server/associate/plausible.h"
#include "fusion-server/associate/ray_matching.h"
#include "fusion-server/flow.h"

namespace chorus::associate {

struct AssociationConfig {
  double gate = 0.6;     ///< Core-joint distance beyond which a body is not this person [m].
  double cluster = 0.4;  ///< New bodies of different sensors closer than this are one person [m].
  double ray_cluster = 0.15;  ///< New people: rays of different cameras pass this close [m].
  int confirm_frames = 3;     ///< A new person is published after so many instants.
  Duration coast = std::chrono::seconds(1);  ///< How long a track survives without any view.
  /// How many instants two confirmed tracks share a spot, but no sensor, before they merge.
  int merge_frames = 15;
  /// How long a body of one sensor waits once others have looked there and seen nobody; 0: not at
  /// all.
  Duration alone = std::chrono::seconds(3);
  /// A sensor surely sees who is within this angle of its optical axis [rad] and this far away [m].
  double look_angle = deg(25);
  double look_range = 4.0;
  BodyLimits bodies = {};

  bool operator==(const AssociationConfig&) const = default;
};

/// Memory of one person between instants.
struct Track {
  PersonId id;
  Timestamp seen;                                      ///< Last instant with a view.
  int hits = 0;                                        ///< Instants with a view.
  Eigen::Vector3d core = Eigen::Vector3d::Zero();      ///< Mean of the core joints, world [m].
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
  int shadowed = 0;  ///< Consecutive instants on an older track's spot without a common sensor.
  Located joints;    ///< Where they were then; known while cameras show rays.
  bool admitted = false;  ///< It may be published; once admitted, always.
  bool doubted = false;   ///< A sensor has looked where it was, and seen nobody.
  Duration alone{0};      ///< How long one sensor alone has seen it since then.
};

struct Tracks {
  std::uint64_t next_id = 1;
  Timestamp instant;  ///< The last one grouped.
  std::vector<Track> people;
};

struct Grouping {
  /// Confirmed and admitted people with at least one view, in id order; at most as many as a frame
  /// holds, and then those that several sensors see.
  std::vector<Person> people;
  Tracks tracks;
};

/// A sensor with a place that has answered for an instant, whether it saw anybody or not.
struct Observer {
  SensorId sensor;
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
};

/// Each view holds a world skeleton of one body; two views of one sensor are never one person.
struct Scene {
  Timestamp instant;
  std::vector<SensorView> views;
  std::vector<Observer> observers = {};  ///< If empty, nobody has to wait.
};

[[nodiscard]] Grouping group(Scene scene, const Tracks& tracks, const AssociationConfig& config);

}  // namespace chorus::associate
