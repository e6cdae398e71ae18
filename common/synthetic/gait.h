// One gait cycle of real walking, cut from a CMU take and closed into a seamless loop.
//
// The loop lives in joint angles, so bone lengths stay exact.  Its root carries only what is left
// after the mean forward motion is taken out (sway, bob, surge); where the person goes is a Path's
// business.
#pragma once

#include <vector>

#include "common/body/skeleton.h"
#include "common/motion/asf_amc.h"

namespace chorus::synthetic {

class Gait {
 public:
  /// Cuts the best-closing cycle out of a take of straight walking.
  Gait(const motion::AsfSkeleton& skeleton, const std::vector<motion::AmcFrame>& take);

  /// The built-in takes, cut once; any number is taken modulo their count.
  [[nodiscard]] static const Gait& built_in(std::size_t take);

  /// The body at `phase` (1 = one whole cycle, any real number) with strides of `amplitude` (1 = as
  /// recorded, 0 = standing): origin on the floor under the mean root, walking towards +z, y = 0
  /// the floor.
  [[nodiscard]] Skeleton<WorldSpace> pose(double phase, double amplitude) const;

  [[nodiscard]] double stride() const noexcept { return stride_; }  ///< Way per cycle [m].
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
  double heading_ = 0.0;  ///< Of the recorded walk; taken out.
};

}  // namespace chorus::synthetic
