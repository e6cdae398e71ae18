// Decides whether a new track may be published. A track that only one sensor sees has to wait once
// another sensor has looked at its place and seen nobody; a track that several sensors see has to
// wait while at least twice as many miss it.
//
// Such bodies come from furniture, mirrors, and sensors that are not where they were registered.  A
// sensor looks into a cone about its optical axis; a person in front of a place hides the place.
#pragma once

#include <map>
#include <vector>

#include "fusion-server/associate/person_association.h"

namespace chorus::associate {

/// A body seen at the present instant, and the track to which it was assigned.
struct Assigned {
  SensorId sensor;
  Eigen::Vector3d core = Eigen::Vector3d::Zero();  ///< World [m].
  PlanError error = PlanError::Zero();             ///< Of `core`, as the sensor states it.
  PersonId track;
  bool settled = false;  ///< True if the track is already published.
};

class Admission {
 public:
  /// `elapsed`: time since the previous instant. `by_walking`: nobody is missing, and the room
  /// has been observed for config.motionless, so that people come in by walking.
  Admission(const std::vector<Observer>& observers, const std::vector<Assigned>& bodies,
            Duration elapsed, bool by_walking, const AssociationConfig& config);

  /// Sets `admitted` in three cases:
  ///   - several sensors see the track, and fewer than twice as many miss it;
  ///   - the track is confirmed, no sensor that looks there has ever missed it, and it does not
  ///     appear at rest;
  ///   - otherwise, the track has been seen for config.alone, mostly by one sensor alone.
  /// The time for config.alone runs n times slower while this sensor has n unpublished bodies that
  /// only it sees.  It stops while seen_through() is true.  It also stops while several other
  /// sensors see a published person where this sensor looks, and this one does not: its body is
  /// then taken for that person, misplaced.
  void judge(Track& track) const;

  /// True if sensors on different sides look at `place` and see nobody there who could be the
  /// track's person. Then the person is not there: nothing can hide a place from all sides.
  [[nodiscard]] bool seen_through(const Track& track, const Eigen::Vector3d& place) const;

 private:
  [[nodiscard]] bool looks_at(const Observer& observer, const Eigen::Vector3d& place) const;
  [[nodiscard]] bool hidden_from(const Observer& observer, const Eigen::Vector3d& place) const;
  [[nodiscard]] bool misses(const Observer& observer, const Track& track,
                            const Eigen::Vector3d& place) const;
  [[nodiscard]] std::size_t count_missing(const Track& track) const;
  [[nodiscard]] bool misplaces(const SensorId& sensor) const;
  [[nodiscard]] bool appears_at_rest(const Track& track) const;
  [[nodiscard]] const std::vector<Assigned>& bodies_of(const SensorId& sensor) const;
  [[nodiscard]] std::int64_t alone_in(const SensorId& sensor) const;

  const std::vector<Observer>& observers_;
  std::map<SensorId, std::vector<Assigned>> bodies_;
  std::map<PersonId, std::vector<Assigned>> tracks_;  ///< The same bodies, grouped by track.
  Duration elapsed_;
  bool by_walking_;
  const AssociationConfig& config_;
};

}  // namespace chorus::associate
