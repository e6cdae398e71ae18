// Which bodies of which sensors are the same person, now and over time.
//
// Per instant: where tracks are expected is matched with the bodies of all sensors, together
// (matching.h); bodies left over are clustered across sensors into new people.  Two tracks on one
// spot that never share a sensor are one person and become the older one.  A person whom only one
// sensor sees where others look is not published at once (admission.h).  Whoever is not seen is
// looked for where they should be; whoever left is remembered, and known again by their build
// (recognition.h).  Bodies of cameras without depth, whose joints are rays, are matched by how far
// their rays pass the joints of a track (ray_matching.h); a single one founds nobody, and does not
// keep anybody alive.  Ids are never reused.
#pragma once

#include <vector>

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/track.h"
#include "fusion-server/flow.h"

namespace chorus::associate {

struct Grouping {
  /// Confirmed, admitted and named people, in id order, seen or carried; at most as many as a frame
  /// holds, and then those that several sensors see.
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
