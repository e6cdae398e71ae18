// The vectors left - right of a body's joint pairs; they change sign when a tracker swaps sides.
#pragma once

#include <array>
#include <optional>

#include "fusion-server/flow/person.h"

namespace chorus::facing {

/// The left joints of the pairs whose direction shows where left is, trunk first.
inline constexpr std::array<JointId, 6> kSidePairs{JointId::ShoulderLeft, JointId::HipLeft,
                                                   JointId::ElbowLeft,    JointId::KneeLeft,
                                                   JointId::WristLeft,    JointId::AnkleLeft};

/// The vector left - right of each pair, world [m]; shortened if it is longer than 0.7 m or a joint
/// of the pair is inferred, zero if one is not seen.
using Spans = std::array<Eigen::Vector3d, kSidePairs.size()>;

inline constexpr double kMinSpan = 0.05;  ///< [m]; shorter spans have no direction.

[[nodiscard]] Spans no_spans();

[[nodiscard]] Spans spans_of(const Skeleton<WorldSpace>& body);

/// Root of the sum of the squared lengths of all spans [m].
[[nodiscard]] double size_of(const Spans& spans);

/// Sum of the dot products of corresponding spans [m^2]; negative if one of the two has its sides
/// swapped.
[[nodiscard]] double agreement(const Spans& a, const Spans& b);

/// Exchanges left and right.  The body loses its orientations, because they describe one that faces
/// the sensor.
void exchange_sides(Skeleton<WorldSpace>& body);

/// Unit vector to the left of a body with these spans; zero when unknown.
[[nodiscard]] Eigen::Vector3d left_of(const Spans& spans);

/// Horizontal unit vector in the direction in which a body with these spans faces; zero when
/// unknown.
[[nodiscard]] Eigen::Vector3d forward_of(const Spans& spans);

/// Otto's phi: the yaw from the direction to the sensor to the direction in which the body faces,
/// in (-pi, pi]; none when unknown.
[[nodiscard]] std::optional<double> facing_of(const SensorView& view,
                                              const Eigen::Vector3d& forward);

/// The spans on which the views agree when there are no earlier spans: each view is tried as the
/// start, and the start that leads to the best agreement wins.
[[nodiscard]] Spans agreed_spans(const std::vector<Spans>& views);

}  // namespace chorus::facing
