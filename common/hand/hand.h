// A hand in a picture: what the network sees, what its outline shows, and both together.
//
// Pixels: x right, y down, the upper left corner of the picture is (0, 0).  Fingers are numbered
// from the thumb (0) to the little finger (4), joints as in common/layout/hand.h.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "common/layout/hand.h"

namespace chorus::hand {

using layout::hand_joint;
using layout::kFingerJoints;
using layout::kFingers;
using layout::kHandJoints;
using Pixel = Eigen::Vector2d;
using Joints = std::array<Pixel, kHandJoints>;

inline constexpr std::array<std::string_view, kFingers> kFingerNames{"thumb", "index", "middle",
                                                                     "ring", "little"};

enum class Side { Left, Right };

[[nodiscard]] constexpr std::string_view name_of(Side side) noexcept {
  return side == Side::Left ? "left" : "right";
}

/// A hand as a network sees it.
struct SeenHand {
  double score = 0.0;  ///< How sure it is that this is a hand, 0 to 1.
  Side side = Side::Right;
  double side_score = 0.0;
  Joints joints{};
};

/// The outline of everything that may be one hand.
struct Outline {
  std::vector<Pixel> points;   ///< Closed, dense, clockwise in the picture.
  Pixel palm = Pixel::Zero();  ///< Centre of the largest inscribed circle.
  double palm_radius = 0.0;
  int width = 0;  ///< Of the picture.
  int height = 0;
};

/// One finger on the outline.
struct FingerShape {
  Pixel tip = Pixel::Zero();
  /// Where the finger leaves the palm, towards the thumb's side and away from it.
  std::array<Pixel, 2> base{Pixel::Zero(), Pixel::Zero()};
  double width = 0.0;     ///< Half-way between base and tip [px].
  bool touching = false;  ///< Touches a neighbour, so that its web and width are not known.
  [[nodiscard]] Pixel root() const { return 0.5 * (base[0] + base[1]); }
  [[nodiscard]] double length() const { return (tip - root()).norm(); }
};

using Fingers = std::array<FingerShape, kFingers>;

enum class Origin { Paper, Contour, Both };

/// What the picture says about a hand.
struct HandShape {
  Outline outline;
  Fingers fingers;
  Joints joints{};
  Side side = Side::Right;
  bool side_seen = false;   ///< False: assumed that the palm faces the viewer.
  bool back_seen = false;   ///< The back of the hand faces the viewer.
  bool wrist_seen = false;  ///< False: the wrist's place is estimated from the palm.
  Origin origin = Origin::Contour;
  std::vector<std::string> notes;
};

}  // namespace chorus::hand
