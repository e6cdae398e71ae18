// Which sensors look at a place at one instant, and see somebody or nobody there.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "fusion-server/associate/sight_field.h"
#include "fusion-server/associate/track.h"

namespace chorus::associate {

/// A registered sensor that has delivered a frame for the instant, even if it saw nobody.
struct Observer {
  SensorId sensor;
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  bool knows_floor = false;  ///< True if the floor that it measures is the world's, y = 0.
};

/// A body seen at the present instant, and the track to which it was assigned.
struct Assigned {
  SensorId sensor;
  Eigen::Vector3d core = Eigen::Vector3d::Zero();  ///< World [m].
  PlanError error = PlanError::Zero();             ///< Of `core`, as the sensor states it.
  PersonId track;
  bool settled = false;  ///< True if the track is already published.
  bool on_floor = true;  ///< False if the body is far under the floor or above it.
};

/// An observer that should see somebody and does not.
struct Miss {
  const Observer* observer = nullptr;
  double weight = 1.0;  ///< 1 where it would certainly see them, 0 where it would as often not.
};

class Gaze {
 public:
  /// The arguments must outlive this.  `gate`: a body farther from a person than this is not that
  /// person [m].
  Gaze(const std::vector<Observer>& observers, const std::vector<Assigned>& bodies,
       const SightFields& fields, double gate);

  [[nodiscard]] const std::vector<Observer>& observers() const { return observers_; }
  /// The bodies of a track, of a sensor.
  [[nodiscard]] const std::vector<Assigned>& sights_of(PersonId track) const;
  [[nodiscard]] const std::vector<Assigned>& bodies_of(const SensorId& sensor) const;
  [[nodiscard]] const std::map<PersonId, std::vector<Assigned>>& tracks() const { return tracks_; }

  /// How certainly the observer would see a person at `place` whom nobody hides: 0 to 1, as
  /// Miss::weight; 0 where it would rather not.
  [[nodiscard]] double certainty(const Observer& observer, const Eigen::Vector3d& place) const;
  /// True if a person whom the observer sees, other than `who`, hides `place` from it.
  [[nodiscard]] bool hidden_from(const Observer& observer, const Eigen::Vector3d& place,
                                 PersonId who) const;
  /// True if the observer sees a body at `place` that could be the person's.
  [[nodiscard]] bool sees(const Observer& observer, PersonId who,
                          const Eigen::Vector3d& place) const;
  /// The observers that look at `place`, from which nobody hides it, and that see nobody there who
  /// could be `who`.
  [[nodiscard]] std::vector<Miss> missing(PersonId who, const Eigen::Vector3d& place) const;
  /// True if observers on different sides miss the person at `place`.  Then nobody is there:
  /// nothing hides a place from all sides.
  [[nodiscard]] bool seen_through(PersonId who, const Eigen::Vector3d& place) const;

 private:
  const std::vector<Observer>& observers_;
  const SightFields& fields_;
  double gate_;
  std::map<SensorId, std::vector<Assigned>> bodies_;
  std::map<PersonId, std::vector<Assigned>> tracks_;
};

/// Horizontal direction from a place to an observer, of length 1.
[[nodiscard]] Eigen::Vector2d side_of(const Observer& observer, const Eigen::Vector3d& place);

}  // namespace chorus::associate
