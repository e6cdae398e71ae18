// Finds bodies in a sequence of depth images, follows them, gives them ids and loses them again. It
// does not know the truth.
//
// Like body-tracking SDKs it assumes that people face the sensor: once the shoulders have turned
// beyond the side view, left and right are swapped.
#pragma once

#include <vector>

#include "common/base/strong_id.h"
#include "common/synthetic/depth/body_fit.h"

namespace chorus::synthetic::depth {

struct TrackedBody {
  BodyId id;
  Skeleton<SensorSpace> skeleton;
};

class BodyTracker {
 public:
  explicit BodyTracker(const DepthCamera& camera) : camera_(camera) {}

  /// Returns the bodies of the next image.  `floor`: as the sensor estimates it.
  [[nodiscard]] std::vector<TrackedBody> look(const DepthImage& image, const Plane& floor);

 private:
  struct Track {
    BodyId id;
    FittedBody body;
    std::vector<SurfacePoint> points;
    int age = 0;   ///< Number of frames since the body was found.
    int poor = 0;  ///< Frames in a row with too few points, a bad fit or a hidden trunk.
    std::array<int, kNodeCount> unseen{};  ///< Frames in a row with too little support.
  };

  void share_out(const Foreground& foreground, std::vector<bool>& unexplained);
  void follow(Track& track, const DepthImage& image, const Plane& floor);
  void give_up();
  void welcome(const std::vector<SurfacePoint>& piece, const DepthImage& image, const Plane& floor);
  [[nodiscard]] Evidence evidence_of(const Track& track, const DepthImage& image,
                                     const Plane& floor) const;
  [[nodiscard]] TrackedBody report(const Track& track) const;

  DepthCamera camera_;
  std::vector<Track> tracks_;
  std::uint64_t next_id_ = 1;
};

}  // namespace chorus::synthetic::depth
