// Which bodies of which sensors are the same person, now and over time.
//
// At each instant, the expected places of tracks are matched with the bodies of all sensors jointly
// (matching.h); the remaining bodies are clustered across sensors into new people.  Two tracks on
// one spot that never share a sensor are one person; the older one stays.  A person whom only one
// sensor sees where others look is not published at once (admission.h).  People who are not seen
// are looked for where they should be; those who left are remembered and recognised by their build
// (recognition.h).  Ray bodies of cameras without depth are matched by how far their rays pass from
// the joints of a track (ray_matching.h); one alone starts no track and keeps none alive.  Ids are
// never reused.
#pragma once

#include <vector>

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/track.h"
#include "fusion-server/flow.h"

namespace chorus::associate {

struct Grouping {
  /// Confirmed, admitted and named people, ordered by id, seen or predicted; at most as many as a
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
