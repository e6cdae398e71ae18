// Association as a first attempt would do it: every body goes to the nearest person of the previous
// instant, nearest pairs first, without prediction and without later correction.
#pragma once

#include <cstdint>
#include <vector>

#include "fusion-server/flow/person.h"

namespace chorus::bench::baselines {

class NearestNeighbour {
 public:
  /// The people at this instant who were seen at three instants or more.  A person unseen for a
  /// second is forgotten.  A person gets at most one body of each sensor; a body without such a
  /// person within 0.6 m is a new person.
  [[nodiscard]] std::vector<Person> group(const std::vector<SensorView>& views, Timestamp instant);

 private:
  struct Track {
    PersonId id;
    Timestamp seen;
    int hits = 0;
    Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< World x, z [m]
    std::vector<const SensorView*> views;
  };
  void assign(const std::vector<SensorView>& views);
  void add_newcomers(const std::vector<SensorView>& views);

  std::vector<Track> tracks_;
  std::uint64_t next_id_ = 1;
};

/// Mean place of the seen core joints, world x and z; not finite without any.
[[nodiscard]] Eigen::Vector2d place_of(const Skeleton<WorldSpace>& body);

}  // namespace chorus::bench::baselines
