// One gait cycle of real walking, cut from a CMU take and closed to a seamless loop.
//
// The loop consists of joint angles, so bone lengths stay exact.  Its root keeps only the motion
// that is left after the mean forward motion has been removed (sway, bob, surge); where the person
// goes is determined by a Path.
#pragma once

#include <vector>

#include "common/body/skeleton.h"
#include "common/motion/asf_amc.h"

namespace chorus::synthetic {

/// Height of the foot joint above the floor while standing [m].
inline constexpr double kToeHeight = 0.03;

class Gait {
 public:
  /// Cuts one cycle out of a take of straight walking, so that its ends fit together best.
  Gait(const motion::AsfSkeleton& skeleton, const std::vector<motion::AmcFrame>& take);

  /// The cycle of one of the built-in takes, which are cut once; `take` is taken modulo their
  /// number.
  [[nodiscard]] static const Gait& built_in(std::size_t take);

  /// The body at `phase` (any real number; a cycle has length 1) with strides of `amplitude` (1: as
  /// recorded, 0: standing).  The origin is on the floor, which is y = 0, under the mean root; the
  /// body walks towards +z.
  [[nodiscard]] Skeleton<WorldSpace> pose(double phase, double amplitude) const;

  [[nodiscard]] double stride() const noexcept { return stride_; }  ///< Distance per cycle [m].
  [[nodiscard]] double period() const noexcept { return period_; }  ///< Duration of a cycle [s].
  [[nodiscard]] double speed() const noexcept { return stride_ / period_; }  ///< As recorded [m/s].

 private:
  [[nodiscard]] motion::AmcFrame channels(double phase, double amplitude) const;
  void close_loop(const std::vector<motion::AmcFrame>& take, std::size_t start, std::size_t length);
  void stand_on_floor();

  const motion::AsfSkeleton* skeleton_;
  std::vector<motion::AmcFrame> cycle_;  ///< Root translation is relative to the mean motion.
  motion::AmcFrame standing_;
  double stride_ = 0.0;
  double period_ = 0.0;
  /// Yaw of the recorded walk [rad]; pose() turns it to +z.
  double heading_ = 0.0;
};

}  // namespace chorus::synthetic
