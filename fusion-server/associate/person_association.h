// Decides which bodies of which sensors are the same person, now and over time.
//
// At each instant, the bodies of all sensors are matched jointly with where tracks are expected
// (matching.h); the remaining bodies are clustered across sensors into new people. Two tracks that
// different sensors see on one spot are one person; two published tracks only once this has lasted
// for merge_frames. A published track stays rather than an unpublished one, otherwise the older. A
// track is published only while more sensors see the person than miss them (existence.h). People
// who are not seen are looked for where they are expected. Those who left are remembered, and
// recognised by their build (recognition.h). Of people who wear inertial sensors, what these say of
// the limbs counts as well (worn_likeness.h). Ray bodies of cameras without depth are matched by
// how far their rays pass from the joints of a track (ray_matching.h); a single ray body starts no
// track and keeps none alive. A new person never gets an id that was used before.
#pragma once

#include <vector>

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/gaze.h"
#include "fusion-server/associate/track.h"
#include "fusion-server/flow/correction.h"
#include "fusion-server/flow/person.h"
#include "fusion-server/flow/standing.h"
#include "fusion-server/flow/worn_people.h"

namespace chorus::associate {

struct Grouping {
  /// The confirmed, admitted and named people, seen or expected, ordered by id.  At most as many as
  /// a frame holds; if there are more, those whom several sensors see are preferred.
  std::vector<Person> people;
  /// What the sensors say of everybody whom some of them see, published or not.
  std::vector<Standing> standings;
  Tracks tracks;
  /// Who was published under another's id until now.
  std::vector<Correction> corrections = {};
};

/// All bodies at one instant: each view contains the world skeleton of one body.  Two views of the
/// same sensor are never one person.
struct Scene {
  Timestamp instant;
  std::vector<SensorView> views;
  std::vector<Observer> observers = {};  ///< If empty, nobody is contradicted.
  WornPeople worn = {};                  ///< Who wears inertial sensors, and what these say.
};

[[nodiscard]] Grouping group(Scene scene, const Tracks& tracks, const AssociationConfig& config);

}  // namespace chorus::associate
