// Whether a new track may be published: a body that only one sensor sees, at a place where other
// sensors look and see nobody, has to wait.
//
// Such bodies come from furniture, mirrors, and sensors that stand elsewhere than registered.  A
// sensor looks at a cone about its optical axis; a person in front of a place hides it.
#pragma once

#include <map>
#include <vector>

#include "fusion-server/associate/person_association.h"

namespace chorus::associate {

/// A body at the instant and the track it was assigned to.
struct Assigned {
  SensorId sensor;
  Eigen::Vector3d core = Eigen::Vector3d::Zero();  ///< World [m].
  PersonId track;
  bool settled = false;  ///< The track is already published.
};

class Admission {
 public:
  /// `elapsed`: time since the previous instant.
  Admission(const std::vector<Observer>& observers, const std::vector<Assigned>& bodies,
            Duration elapsed, const AssociationConfig& config);

  /// Sets `admitted` when a second sensor sees the track, and not twice as many miss it; or when it
  /// is confirmed and no sensor that looks there has missed it; or when one sensor alone has seen
  /// it for config.alone.  That time runs n times slower while its sensor has n such bodies, and
  /// stops while its sensor misses a person whom others see in its view (the body is then taken for
  /// that person, misplaced), and while others see through it.
  void judge(Track& track) const;

  /// Sensors on different sides look at `place` and see nobody there who could be that track:
  /// nothing can occlude it from all of them.
  [[nodiscard]] bool seen_through(const Track& track, const Eigen::Vector3d& place) const;

 private:
  [[nodiscard]] bool looks_at(const Observer& observer, const Eigen::Vector3d& place) const;
  [[nodiscard]] bool hidden_from(const Observer& observer, const Eigen::Vector3d& place) const;
  [[nodiscard]] bool misses(const Observer& observer, const Track& track,
                            const Eigen::Vector3d& place) const;
  [[nodiscard]] std::size_t count_missing(const Track& track) const;
  [[nodiscard]] bool misplaces(const SensorId& sensor) const;
  [[nodiscard]] const std::vector<Assigned>& bodies_of(const SensorId& sensor) const;
  [[nodiscard]] std::int64_t alone_in(const SensorId& sensor) const;

  const std::vector<Observer>& observers_;
  std::map<SensorId, std::vector<Assigned>> bodies_;
  std::map<PersonId, std::vector<Assigned>> tracks_;  ///< The same bodies, grouped by track.
  Duration elapsed_;
  const AssociationConfig& config_;
};

}  // namespace chorus::associate
