// Whether a new track may be published: a body that one sensor alone sees, at a place where others
// look and see nobody, has to wait.
//
// Furniture, mirrors and a sensor that stands elsewhere than it is registered make such bodies.
// What a sensor looks at is a cone about its optical axis; who stands before the place hides it.
#pragma once

#include <map>
#include <vector>

#include "fusion-server/associate/person_association.h"

namespace chorus::associate {

/// A body of the instant and the track that it went to.
struct Assigned {
  SensorId sensor;
  Eigen::Vector3d core = Eigen::Vector3d::Zero();  ///< World [m].
  PersonId track;
  bool settled = false;  ///< The track is published already.
};

class Admission {
 public:
  /// `elapsed`: since the instant before.
  Admission(const std::vector<Observer>& observers, const std::vector<Assigned>& bodies,
            Duration elapsed, const AssociationConfig& config);

  /// Sets `admitted` when a second sensor sees the track; or when it is confirmed and no sensor
  /// that looks there has missed it; or when it has been alone for config.alone.  That time runs n
  /// times as slowly while its sensor has n such bodies, and stands still while its sensor misses
  /// somebody whom others see where it looks: then the body is taken to be that person, misplaced.
  void judge(Track& track) const;

 private:
  [[nodiscard]] bool looks_at(const Observer& observer, const Eigen::Vector3d& place) const;
  [[nodiscard]] bool hidden_from(const Observer& observer, const Eigen::Vector3d& place) const;
  [[nodiscard]] bool misses(const Observer& observer, const Track& track) const;
  [[nodiscard]] bool misplaces(const SensorId& sensor) const;
  [[nodiscard]] const std::vector<Assigned>& bodies_of(const SensorId& sensor) const;
  [[nodiscard]] std::int64_t alone_in(const SensorId& sensor) const;

  const std::vector<Observer>& observers_;
  std::map<SensorId, std::vector<Assigned>> bodies_;
  std::map<PersonId, std::vector<Assigned>> tracks_;  ///< The same bodies, by track.
  Duration elapsed_;
  const AssociationConfig& config_;
};

}  // namespace chorus::associate
