// Which sensors contradict the others, before any chain is built on them.
//
// A sensor that followed somebody else, that is mirrored, or whose clock is wrong can still fit one
// other sensor by chance.  It cannot fit all of them: pairs that saw a person at the same instants
// and do not agree speak against both of their sensors, and so do three pairs whose product around
// a triangle is not the identity.  Whoever has more against them than for them is cast out, one at
// a time, until nothing contradicts the rest.  Derived in docs/papers/registration.md, Section 11.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fusion-server/flow.h"

namespace chorus::registration {

/// Two sensors that saw a person at the same instants but do not agree about it.
struct Contradiction {
  SensorId target;
  SensorId source;
};

struct Outcast {
  SensorId sensor;
  std::string reason;  ///< A full sentence that names the sensor.
};

/// What the pairs found.
struct Evidence {
  std::vector<PairwiseRegistration> edges;
  std::vector<Contradiction> contradictions;
  std::map<SensorId, Eigen::Vector3d> middles;  ///< Of each sensor's walk, in its own space.
};

/// How far the walk's middle is off after once around the triangle of these three edges [m];
/// infinite where they turn it by more than 15 deg.
[[nodiscard]] double loop_error(const PairwiseRegistration& ab, const PairwiseRegistration& bc,
                                const PairwiseRegistration& ca, const Evidence& evidence);

/// The sensors to leave out, in the order in which they were found, and removes their edges and
/// contradictions from the evidence.  Never leaves fewer than two sensors that agree: of two
/// sensors that contradict one another, nobody can say which is wrong.
[[nodiscard]] std::vector<Outcast> cast_out(Evidence& evidence);

}  // namespace chorus::registration
