// Skeleton layouts: which landmarks a tracker provides, in which order, and how our joints are
// computed from them.  Each layout's table is in its own file, with the published source of the
// order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "common/base/result.h"
#include "common/body/skeleton.h"

namespace chorus::layout {

/// The weight of one landmark in a joint.
struct Share {
  std::uint8_t landmark = 0;
  double weight = 0.0;
};

/// A joint as a weighted mean of landmarks.
struct Recipe {
  JointId joint = JointId::SpineBase;
  std::array<Share, 4> shares;  ///< Weights sum to one; unused shares have weight zero.
};

/// The landmarks that tell how the head is turned; all zero: the layout lacks some.
struct HeadMarks {
  std::uint8_t nose = 0;
  std::uint8_t left_eye = 0;
  std::uint8_t right_eye = 0;
  std::uint8_t left_ear = 0;
  std::uint8_t right_ear = 0;

  [[nodiscard]] constexpr bool known() const { return left_ear != right_ear; }
};

struct Layout {
  std::string_view name;                        ///< "mediapipe_33"
  std::string_view tracker;                     ///< The tracker's human-readable name.
  std::string_view source;                      ///< Where the order of the landmarks is published.
  std::span<const std::string_view> landmarks;  ///< By number, in the spelling of the source.
  /// How the joints are made; a joint without an entry is not provided.  Where several entries make
  /// the same joint, the first entry that is seen counts; the later ones are substitutes, which
  /// make the joint Inferred at best.
  std::span<const Recipe> recipes;
  double tracked_from = 0.0;   ///< Lowest confidence (0 to 1) of a Tracked landmark.
  double inferred_from = 0.0;  ///< Lowest confidence of an Inferred landmark.
  HeadMarks head = {};
};

/// All layouts.
[[nodiscard]] std::span<const Layout* const> layouts();

/// The layout with this name; otherwise NotFound, with a list of the known layouts.
[[nodiscard]] Result<const Layout*> find_layout(std::string_view name);

[[nodiscard]] std::optional<std::size_t> landmark_named(const Layout& layout,
                                                        std::string_view name);

[[nodiscard]] JointState state_of(double confidence, double tracked_from, double inferred_from);

/// One landmark, in the form of a Joint: a point [m], or a ray.
struct Landmark {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  JointState state = JointState::NotTracked;
  Measurement measurement = Measurement::Point;
  Covariance covariance = {};
};

/// Computes our joints from landmarks in the layout's order; landmarks missing at the end are not
/// tracked.  A joint is as certain as its least certain landmark.  Its covariance assumes that the
/// landmarks' errors are independent, and is known if all their covariances are.  For rays, the
/// directions are averaged; with landmarks at different depths the result is only nearly the ray to
/// their centre (off by 3 mm for hips at 3 m).  Landmarks have no orientation, so the joints have
/// none, except Head where the layout has marks and all are seen as points (head_turn()).
[[nodiscard]] std::array<Joint, kJointCount> joints_of(const Layout& layout,
                                                       std::span<const Landmark> landmarks);

/// The orientation of the head (+y to the crown, +z to the face, +x to its left) from points: x
/// from ear to ear, z from the middle of the ears to the middle of nose and eyes, which lies level
/// with the ears in a head held upright (the eyes above, the nose below the Frankfurt plane).  None
/// if a mark is not seen as a point, or all lie on a line.
[[nodiscard]] std::optional<Eigen::Quaterniond> head_turn(const Layout& layout,
                                                          std::span<const Landmark> landmarks);

}  // namespace chorus::layout
