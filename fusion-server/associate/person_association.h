// Which bodies of which sensors are the same person, now and over time.
//
// At each instant, predicted tracks are matched with world bodies by the horizontal distance of
// their core joints (people do not stand on one another, and an occluded hip must not lift a body
// away from its track), one-to-one per sensor; the remaining bodies are clustered across sensors
// into new people.  Two tracks on one spot that never share a sensor are one person; the older one
// stays.  A person whom only one sensor sees where others look is not published at once
// (admission.h).  Ray bodies of cameras without depth are matched by how far their rays pass from
// the joints of a track (ray_matching.h); one alone starts no track and keeps none alive.  Ids are
// never reused.
#pragma once

#include <cstdint>
#include <vector>

#include "common/base/units.h"
#include "fusion-server/associate/plausible.h"
#include "fusion-server/associate/ray_matching.h"
#include "fusion-server/flow.h"

namespace chorus::associate {

struct AssociationConfig {
  double gate = 0.6;          ///< Core joints farther apart [m]: the body is not this person.
  double cluster = 0.4;       ///< New bodies of different sensors this close are one person [m].
  double ray_cluster = 0.15;  ///< New people: rays of different cameras pass this close [m].
  int confirm_frames = 3;     ///< Instants a new person is seen before it is published.
  Duration coast = std::chrono::seconds(1);  ///< How long a track survives without any view.
  /// Two confirmed tracks merge after this many instants on one spot without a common sensor.
  int merge_frames = 15;
  /// How long a body seen by only one sensor must persist before it is published, if other sensors
  /// look at that place and see nobody; 0: no wait.
  Duration alone = std::chrono::seconds(3);
  /// A sensor surely sees a person this close to its optical axis [rad] and this near [m].
  double look_angle = deg(25);
  double look_range = 4.0;
  BodyLimits bodies = {};

  bool operator==(const AssociationConfig&) const = default;
};

/// What is remembered of one person between instants.
struct Track {
  PersonId id;
  Timestamp seen;                                      ///< Last instant with a view of it.
  int hits = 0;                                        ///< Number of instants with a view.
  Eigen::Vector3d core = Eigen::Vector3d::Zero();      ///< Mean of the core joints, world [m].
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
  int shadowed = 0;  ///< Consecutive instants on an older track's spot without a common sensor.
  Located joints;    ///< Where its joints were then; known while cameras show rays.
  bool admitted = false;  ///< It may be published; once admitted, always.
  bool doubted = false;   ///< Another sensor looked at its place and saw nobody.
  Duration alone{0};      ///< How long only one sensor has seen it since then.
};

struct Tracks {
  std::uint64_t next_id = 1;
  Timestamp instant;  ///< The last instant that was grouped.
  std::vector<Track> people;
};

struct Grouping {
  /// Confirmed and admitted people with at least one view, ordered by id; at most as many as a
  /// frame holds, preferring those whom several sensors see.
  std::vector<Person> people;
  Tracks tracks;
};

/// A registered sensor that has delivered for an instant, whether it saw anybody or not.
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
