// A person who plays captured motion for ever: the truth that simulated sensors look at.
//
// The motion is played forwards, then backwards, and so on (a take of walking does not end where it
// began, and a cross-fade would slide the feet and bend the bones).  Around both ends time slows
// down and turns, so that neither place nor velocity jumps.  Between frames positions follow a
// Catmull-Rom spline.
//
// A pure function of the motion, the script and the time since an epoch: every process that has
// them sees the same person at the same instant.
#pragma once

#include <memory>
#include <vector>

#include "common/synthetic/performance.h"
#include "common/synthetic/scene.h"

namespace chorus::synthetic {

struct PerformerScript {
  std::size_t role = 0;                              ///< Index into Performance::roles.
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< Of the performance; world x, z [m]
  double turn = 0.0;                                 ///< Of it about its own centre, as yaw [rad]
  double body_scale = 1.0;  ///< Scales ways too, so that feet do not slide.
  Duration start{0};        ///< Place in the loop at the epoch.
};

class Performer {
 public:
  /// A role that the performance does not have gives a body that is not tracked.
  Performer(std::shared_ptr<const Performance> performance, const PerformerScript& script);

  /// All 25 joints, tracked, world space.
  [[nodiscard]] Skeleton<WorldSpace> at(Duration since_epoch) const;
  /// Forwards and back.
  [[nodiscard]] Duration loop() const noexcept { return loop_; }

 private:
  std::shared_ptr<const Performance> performance_;
  PerformerScript script_;
  Duration loop_{1};
};

/// `count` people who play it at the script's centre.  People of one file stay together as
/// captured.  If there are more people than the file has, further groups play it again: evenly on a
/// circle of the script's reach, each turned, of another build, and elsewhere in the loop.  Only
/// the script's seed, centre, reach and body_scale are used.
[[nodiscard]] std::vector<Person> make_performers(std::shared_ptr<const Performance> performance,
                                                  const WalkerScript& script, std::size_t count);

}  // namespace chorus::synthetic
