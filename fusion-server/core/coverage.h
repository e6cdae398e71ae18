// What the walk of a session has covered so far: which sensors saw somebody together, and where.
//
// No extrinsics are needed for the pairs: whether two sensors saw somebody together is judged by
// the time of receipt, and how far the person walked is measured in the space of one of the two.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/sensor/sensor_frame.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/status/session_status.h"

namespace chorus::core {

class Coverage {
 public:
  void clear();
  /// Takes a frame. A frame with several bodies is treated as an empty one, because the bodies
  /// cannot be matched; so is a frame that does not show the neck.
  void add(const SensorFrame& frame);

  /// All pairs that saw somebody together, ordered by the sensors' names.
  [[nodiscard]] std::vector<PairCoverage> pairs() const;
  /// The squares of the floor in which sensors that have a place saw somebody, each with the number
  /// of these sensors.
  [[nodiscard]] std::vector<CoveredCell> cells(const Registration& registration) const;

 private:
  struct Sight {
    Timestamp received;
    Eigen::Vector3d place;       ///< Position of the neck in the sensor's space [m].
    std::set<SensorId> counted;  ///< The sensors with which this view was already counted.
  };
  struct Common {
    std::size_t sightings = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< Sum of the neck's positions in the first
                                                    ///< sensor's space [m].
    double squares = 0.0;
    double distance = 0.0;  ///< Sum of the mean distances from both sensors [m].
  };
  using Cell = std::pair<int, int>;

  std::map<SensorId, Sight> newest_;
  std::map<std::pair<SensorId, SensorId>, Common> common_;
  std::map<SensorId, std::map<Cell, Eigen::Vector3d>> seen_;  ///< The last neck in each cell, in
                                                              ///< each sensor's own space.
};

/// The 95 % radius [m] to which the place of one sensor will be known relative to the other's, for
/// a pair with this many common views (docs/papers/registration.md, Coverage).
[[nodiscard]] double expected_radius(std::size_t sightings, double spread, double distance);

/// Sentences for people about what the walk still needs: one for each sensor that is not connected
/// with the largest group of sensors by pairs within `target` [m], in the order of their ids.
/// `seeing`: the sensors that saw somebody during the walk; with fewer than two there is no
/// sentence.
[[nodiscard]] std::vector<std::string> needs(const std::vector<PairCoverage>& pairs,
                                             const std::set<SensorId>& seeing, double target);

}  // namespace chorus::core
