// Association as a first attempt would have it: every body goes to the nearest person of the last
// instant, nearest first, without prediction and without correcting itself later.
#pragma once

#include <cstdint>
#include <vector>

#include "fusion-server/flow.h"

namespace chorus::bench::baselines {

class NearestNeighbour {
 public:
  /// The people of this instant: those seen for three instants or more.  A person unseen for a
  /// second is forgotten; a body further than 0.6 m from everybody is somebody new.
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
