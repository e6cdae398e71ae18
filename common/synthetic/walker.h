// A person made from CMU recordings of real walking: the truth that simulated sensors observe.
//
// A pure function of the script and the time since an epoch: all processes with the same script see
// the same person at the same instant.
#pragma once

#include "common/body/skeleton.h"
#include "common/synthetic/gait.h"
#include "common/synthetic/path.h"

namespace chorus::synthetic {

struct WalkerScript {
  std::uint64_t seed = 1;
  PathKind path = PathKind::Random;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< World x, z [m]
  double reach = 1.2;                                ///< Reach of the path, see PathScript [m]
  double speed = 0.9;                                ///< [m/s]
  double body_scale = 1.0;                           ///< 1: the recorded subject, about 1.7 m tall.
};

class Walker {
 public:
  explicit Walker(const WalkerScript& script);

  /// All 25 joints, tracked, in world space.
  [[nodiscard]] Skeleton<WorldSpace> at(Duration since_epoch) const;
  [[nodiscard]] const Path& path() const& noexcept { return path_; }
  const Path& path() && = delete;  // The reference would dangle: the walker is a temporary.

 private:
  double body_scale_;
  const Gait* gait_;
  Path path_;
};

}  // namespace chorus::synthetic
