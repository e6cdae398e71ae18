// Finds the sensors that contradict the others, before any chain is built on them.
//
// A sensor that followed somebody else, that is mirrored, or whose clock is wrong can still fit one
// other sensor by chance. It cannot fit all of them. A pair that saw a person at the same instants
// but does not agree is evidence against both of its sensors, and so are three edges whose product
// around a triangle is not the identity, against all three. The sensor with the worst evidence is
// cast out, one at a time, until the rest agree well enough. A sensor that only repeats another one
// is cast out, too. Derived in docs/papers/registration.md, Section 11.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fusion-server/flow/pairwise_registration.h"

namespace chorus::registration {

/// Two sensors that saw a person at the same instants but do not agree about it.
struct Contradiction {
  SensorId target;
  SensorId source;
};

/// What the reason for an outcast says, which its verdict then has.
inline constexpr std::string_view kContradicts = " contradicts ";

struct Outcast {
  SensorId sensor;
  std::string reason;  ///< A full sentence that names the sensor.
};

/// The results of the pairs.
struct Evidence {
  std::vector<PairwiseRegistration> edges;
  std::vector<Contradiction> contradictions;
  std::map<SensorId, Eigen::Vector3d> middles;  ///< Middle of each sensor's walk, in its own space.
};

/// Going once around the triangle of these three edges moves the middle of the walk by this
/// distance [m]; infinite if it also turns it by more than 15 deg.
[[nodiscard]] double loop_error(const PairwiseRegistration& ab, const PairwiseRegistration& bc,
                                const PairwiseRegistration& ca, const Evidence& evidence);

/// Returns the sensors to leave out, in the order in which they were found, and removes their edges
/// and contradictions from the evidence. Sensors that repeat others are removed in any case; apart
/// from that, at least one edge stays, and of only two sensors none is removed, because it would be
/// unknown which is wrong.
[[nodiscard]] std::vector<Outcast> cast_out(Evidence& evidence);

}  // namespace chorus::registration
