// A person who plays captured motion for ever: the truth that simulated sensors observe.
//
// The motion is played forwards, then backwards, and so on: a take of walking does not end where it
// began, and a cross-fade would slide the feet and bend the bones.  Around both ends, time slows
// down and reverses, so that neither positions nor velocities jump.  Between frames, positions
// follow a Catmull-Rom spline.
//
// A pure function of the motion, the script and the time since an epoch: all processes that have
// the same three see the same person at the same instant.
#pragma once

#include <memory>
#include <vector>

#include "common/synthetic/performance.h"
#include "common/synthetic/scene.h"

namespace chorus::synthetic {

struct PerformerScript {
  std::size_t role = 0;  ///< Index into Performance::roles.
  /// World x, z of the performance's centre [m].
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double turn = 0.0;        ///< Yaw about that centre [rad]
  double body_scale = 1.0;  ///< Also scales paths, so that feet do not slide.
  Duration start{0};        ///< Position in the loop at the epoch.
};

class Performer {
 public:
  /// If the performance lacks the role, the body is not tracked.
  Performer(std::shared_ptr<const Performance> performance, const PerformerScript& script);

  /// All 25 joints, tracked, in world space.
  [[nodiscard]] Skeleton<WorldSpace> at(Duration since_epoch) const;
  /// Time for playing the motion forwards and back.
  [[nodiscard]] Duration loop() const noexcept { return loop_; }

 private:
  std::shared_ptr<const Performance> performance_;
  PerformerScript script_;
  Duration loop_{1};
};

/// `count` people who play the motion.  People from one file stay together as captured, at the
/// script's centre.  If there are more people than the file has, several groups play it: evenly
/// spaced on a circle about that centre with the script's reach, each turned accordingly; all but
/// the first have another build and another position in the loop.  Uses only the script's seed,
/// centre, reach and body_scale.
[[nodiscard]] std::vector<Person> make_performers(std::shared_ptr<const Performance> performance,
                                                  const WalkerScript& script, std::size_t count);

}  // namespace chorus::synthetic
