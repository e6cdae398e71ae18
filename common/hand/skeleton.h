// A hand's skeleton in metres: what `chorus scan` writes and a glove's tracker reads.
//
// Rest pose: the hand lies flat, seen on its palm.  Origin: the wrist; +y towards the knuckle of
// the middle finger, +x to the right, +z out of the palm.  So the thumb of a right hand is at +x.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/hand/hand.h"

namespace chorus::hand {

struct Skeleton {
  Side side = Side::Right;
  std::array<Eigen::Vector3d, kHandJoints> joints = at_origin();  ///< Rest pose [m].
  std::array<double, kFingers> widths{};           ///< Of the fingers, half-way [m]; 0: not known.
  double palm_radius = 0.0;                        ///< Of the circle inscribed in the palm [m].
  Eigen::Vector3d palm = Eigen::Vector3d::Zero();  ///< Its centre [m].
  bool relative = false;  ///< No scale is known: scaled to a hand of usual length.

  [[nodiscard]] static std::array<Eigen::Vector3d, kHandJoints> at_origin() {
    std::array<Eigen::Vector3d, kHandJoints> out;
    out.fill(Eigen::Vector3d::Zero());
    return out;
  }
};

/// From wrist to the tip of the middle finger, of the mean of Buryanov and Kotiuk with its carpus
/// [m].
inline constexpr double kUsualLength = 0.187;

/// `mm_per_pixel`: none makes a relative skeleton.
[[nodiscard]] Skeleton skeleton_of(const HandShape& hand, std::optional<double> mm_per_pixel);

/// From wrist to the tip of the middle finger [m].
[[nodiscard]] double length_of(const Skeleton& skeleton);

/// The part of a finger that ends in joint `joint` (1 to 3) [m].
[[nodiscard]] double part_length(const Skeleton& skeleton, std::size_t finger, std::size_t joint);

/// Several pictures of one hand: the median of each bone's offset.  Fails for hands of two sides,
/// for none, and when some have a scale and others none.
[[nodiscard]] Result<Skeleton> median_of(std::span<const Skeleton> shots);

}  // namespace chorus::hand
