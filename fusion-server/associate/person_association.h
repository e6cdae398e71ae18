// Which bodies of which sensors are the same person, now and over time.
//
// Per instant: predicted tracks against world bodies by the horizontal distance of their core
// joints (people do not stand on one another, and an occluded hip must not lift a body away from
// its track), one-to-one per sensor, leftovers clustered across sensors into new people.  Two
// tracks on one spot that never share a sensor are one person and become the older one.  Ids are
// never reused.
#pragma once

#include <cstdint>
#include <vector>

#include "fusion-server/associate/plausible.h"
#include "fusion-server/flow.h"

namespace chorus::associate {

struct AssociationConfig {
  double gate = 0.6;       ///< Core-joint distance beyond which a body is not this person [m].
  double cluster = 0.4;    ///< New bodies of different sensors closer than this are one person [m].
  int confirm_frames = 3;  ///< A new person is published after so many instants.
  Duration coast = std::chrono::seconds(1);  ///< How long a track survives without any view.
  int merge_frames =
      15;  ///< Instants two confirmed tracks share a spot, but no sensor, before they merge.
  BodyLimits bodies;

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
};

struct Tracks {
  std::uint64_t next_id = 1;
  std::vector<Track> people;
};

struct Grouping {
  /// Confirmed ones with at least one view, in id order; at most as many as a frame holds, and then
  /// those that several sensors see.
  std::vector<Person> people;
  Tracks tracks;
};

/// Each view holds a world skeleton of one body; two views of one sensor are never one person.
[[nodiscard]] Grouping group(std::vector<SensorView> views, Timestamp instant, const Tracks& tracks,
                             const AssociationConfig& config);

}  // namespace chorus::associate
