// The 21 joints of each of a person's hands (layout hand_21, common/layout/hand.h), where a sensor
// sees fingers or a glove tells them.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include <Eigen/Geometry>

namespace chorus {

inline constexpr std::size_t kHandPoints = 21;

struct HandPoints {
  std::array<Eigen::Vector3d, kHandPoints> points{};  ///< In the space of the body [m].
  std::optional<double> variance = {};  ///< Of the wrist, mean per axis [m^2], if it is known.

  /// The wrist comes first.
  [[nodiscard]] const Eigen::Vector3d& wrist() const { return points[0]; }
};

struct Hands {
  std::optional<HandPoints> left = {};
  std::optional<HandPoints> right = {};
};

/// Null: no hand is known.  Shared, because few sensors see hands and frames are copied often.
using HandsPtr = std::shared_ptr<const Hands>;

/// The pointer for hands of which there may be none.
[[nodiscard]] HandsPtr shared(Hands hands);

/// Between two instants; s from 0 to 1.  Of hands that one of the two lacks there is none; the
/// variance is the larger one.
[[nodiscard]] std::optional<HandPoints> between(const std::optional<HandPoints>& a,
                                                const std::optional<HandPoints>& b, double s);
[[nodiscard]] HandsPtr between(const HandsPtr& a, const HandsPtr& b, double s);

[[nodiscard]] HandPoints moved(const Eigen::Isometry3d& b_from_a, HandPoints in_a);

}  // namespace chorus
